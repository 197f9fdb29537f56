// A window, or what to do where there is no display.
#pragma once

#include <fmt/format.h>

#include <trocar/core/error.hpp>

#include "shell/window.hpp"

namespace trocar::app {

/// @param otherwise  what does the same without a window  @throws core::EnvironmentLacks that says so
inline Window open_window(const std::string& title, pictures::PictureSize size, const char* otherwise) {
  try {
    return Window(title, size);
  } catch (const core::EnvironmentLacks& lacks) {
    throw core::EnvironmentLacks(fmt::format("{}\n{}", lacks.what(), otherwise));
  }
}

}  // namespace trocar::app
