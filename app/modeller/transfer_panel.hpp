// A transfer function on the screen: points of value and opacity that are dragged, put in and taken away, each with its
// colour.
#pragma once

#include <trocar/volumes/show/transfer.hpp>

namespace trocar::app {

/// Draws it. True: it is another one now.
/// @param low, high  values at its left and right side
/// @param chosen     the point whose colour is shown
bool draw_transfer(volumes::TransferFunction& transfer, double low, double high, int& chosen);

}  // namespace trocar::app
