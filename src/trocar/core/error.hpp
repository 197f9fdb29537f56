// What can go wrong outside the step, and how it is reported: bad input (exit 2) with every fault located, a lacking
// environment (exit 3) with its remedy.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace trocar::core {

struct Location {
  std::string file;
  int line = 0;    ///< 1-based; 0 = whole file
  int column = 0;  ///< 1-based
};

/// One fault: printed as `path:line:col: message`, the message saying what was expected and what stands there.
struct Fault {
  Location at;
  std::string message;
};
std::string to_string(const Fault& fault);

/// A file (or several) with at least one fault. what() is all faults, one a line.
class BadInput : public std::runtime_error {
 public:
  explicit BadInput(std::vector<Fault> faults);
  const std::vector<Fault>& faults() const { return m_faults; }

 private:
  std::vector<Fault> m_faults;
};

/// A device, display or library that this machine lacks; the message says what to do about it.
class EnvironmentLacks : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The exit codes of the command line contract.
enum ExitCode : int { kDone = 0, kGoalNotReached = 1, kBadInput = 2, kEnvironment = 3 };

}  // namespace trocar::core
