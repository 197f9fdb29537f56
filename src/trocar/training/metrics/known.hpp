// Figures in results: what could not be measured is null.
#pragma once

#include <cmath>

#include <trocar/core/json.hpp>

namespace trocar::training {

inline Json known(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace trocar::training
