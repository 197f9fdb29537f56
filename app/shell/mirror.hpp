// Exchanges left and right of what is drawn in the window so far.
#pragma once

#include <trocar/render/frame/frame.hpp>

namespace trocar::app {

/// A part of the window's back buffer.
void mirror(const render::Target& part);

}  // namespace trocar::app
