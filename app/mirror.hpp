// Exchanges left and right of what is drawn in the window so far.
#pragma once

namespace trocar::app {

/// The lower left part of the window's back buffer, `width` x `height` [px].
void mirror(int width, int height);

}  // namespace trocar::app
