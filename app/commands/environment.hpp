// The environment variables that the program reads: one table, shown by `trocar --help` and in the manual pages.
#pragma once

#include <span>

namespace trocar::app {

struct EnvironmentVariable {
  const char* name;
  const char* meaning;  ///< a phrase, with the default
};

std::span<const EnvironmentVariable> environment_variables();

/// @throws core::BadInput for a variable that is set and wrong
void check_environment();

}  // namespace trocar::app
