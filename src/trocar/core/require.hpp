// What a description must hold before a Model is built from it.
#pragma once

#include <stdexcept>

namespace trocar::core {

/// @throws std::invalid_argument that says `what`, unless it holds
inline void require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}

}  // namespace trocar::core
