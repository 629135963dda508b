// throng: all that a program includes.
#pragma once

#include "pipeline/queries/convex_query.hpp"
#include "pipeline/queries/impact_query.hpp"
#include "pipeline/queries/queries.hpp"
#include "pipeline/queries/volume_query.hpp"
#include "pipeline/world/report.hpp"
#include "pipeline/world/world.hpp"
#include "scene/scene.hpp"
#include "scene/settings.hpp"
#include "scene/shapes/level_set.hpp"
