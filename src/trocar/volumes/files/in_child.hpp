// Work of a library that may end the program at damaged input, in a process of its own: when it dies, only it dies.
// Used by the readers only.
#pragma once

#include <functional>
#include <string>

namespace trocar::volumes {

struct ChildResult {
  bool came_back = false;  ///< false: the work crashed, or took too long
  std::string bytes;       ///< what it returned
};

/// Runs `work` in a copy of this process (fork) and waits for what it returns. Where there is no fork, it runs here.
/// @param seconds   after which the child is ended
/// @param most      bytes that it may return
/// The work must not wait for other threads: they are not in the copy.
ChildResult in_child(const std::function<std::string()>& work, int seconds, std::size_t most);

}  // namespace trocar::volumes
