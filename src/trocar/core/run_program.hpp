// Another program is run to its end, and what it says is read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace trocar::core {

struct ProgramEnd {
  bool started = false;
  int status = -1;     ///< its exit status; -1: it did not end by itself
  std::string output;  ///< what it wrote to standard output and standard error, as it came
};

/// Without a shell: arguments are what they are.
/// @param most  bytes of output that are kept; a program that says more is ended
ProgramEnd run_program(const std::filesystem::path& program, std::vector<std::string> arguments, std::size_t most);

}  // namespace trocar::core
