// throng: all that a program includes.
#pragma once

#include "pipeline/queries.hpp"
#include "pipeline/report.hpp"
#include "pipeline/scene.hpp"
#include "pipeline/settings.hpp"
#include "pipeline/world.hpp"
