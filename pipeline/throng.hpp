// throng: all that a program includes.
#pragma once

#include "pipeline/convex_query.hpp"
#include "pipeline/impact_query.hpp"
#include "pipeline/level_set.hpp"
#include "pipeline/queries.hpp"
#include "pipeline/report.hpp"
#include "pipeline/scene.hpp"
#include "pipeline/settings.hpp"
#include "pipeline/volume_query.hpp"
#include "pipeline/world.hpp"
