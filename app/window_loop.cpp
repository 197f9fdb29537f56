#include "window_loop.hpp"

#include <trocar/core/error.hpp>

namespace trocar::app {

Json run_window(const Lesson&, const WindowOptions&) {
  throw core::EnvironmentLacks("this build has no window yet: use --headless");
}

}  // namespace trocar::app
