// Starts a program beside this one, usually Trocar itself with another command ("train", "model", "replay"), and
// reports how it went. Its texts are collected, so that a window can show why it refused to start.
//
//   ChildProgram child({"train", file});            // Trocar itself
//   if (child.failed()) show(child.errors());       // once per picture
//
// A child that still runs when its ChildProgram is destroyed goes on. It never stays behind as a zombie.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace trocar::app {

class ChildProgram {
 public:
  /// @param arguments  without the program's name  @param program  empty: this program again
  /// @param variables  "NAME=value", added to its environment
  /// @throws core::EnvironmentLacks when it cannot be started
  explicit ChildProgram(const std::vector<std::string>& arguments, const std::string& program = "",
                        const std::vector<std::string>& variables = {});
  ~ChildProgram();
  ChildProgram(ChildProgram&& other) noexcept;
  ChildProgram& operator=(ChildProgram&& other) noexcept;

  bool running();                    ///< asks the system: once per picture is enough
  std::optional<int> exit_status();  ///< nothing while it runs; 128 + N when signal N ended it
  bool failed();                     ///< it has ended, and with another exit status than 0
  void ask_to_end();                 ///< as Ctrl-C at a terminal does
  std::string errors() const;        ///< its standard error so far, the last 16 kB at most
  std::string output() const;        ///< its standard output so far, the same

 private:
  void leave();

  pid_t m_child = -1;  ///< -1: it has ended, or was moved from
  std::optional<int> m_status;
  int m_errors = -1, m_output = -1;  ///< files in memory that the child writes
};

}  // namespace trocar::app
