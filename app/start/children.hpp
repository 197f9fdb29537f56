// The programs that the start screen has started: modeller, player, rooms. A refusal is shown where one looks.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "shell/child_program.hpp"

namespace trocar::app {

struct ChildRequest {
  std::string title;                   ///< for people: "The modeller"
  std::vector<std::string> arguments;  ///< empty: nothing is asked for
  std::vector<std::string> variables;  ///< "NAME=value"
  bool ends_with_this = false;         ///< it has no window by which it could be closed
};

class Children {
 public:
  Children() = default;
  ~Children();  ///< those that have a window stay open
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;

  /// One of each title: while it runs another is not started.
  void start(const ChildRequest& request);
  /// Looks after them. Once per picture.  @param now [s]
  void poll(double now);
  bool running(const std::string& title) const { return m_running.count(title) > 0; }
  void stop(const std::string& title);
  /// Standard output of the last one of this title, while it runs and after.
  std::string output(const std::string& title) const;

  const std::string& news() const { return m_news; }  ///< one is starting, or has refused; empty: nothing
  bool refused() const { return m_refused; }          ///< the news is a failure
  void forget_news() { m_news.clear(), m_refused = false; }

 private:
  void ended(const std::string& title, ChildProgram& child);

  std::map<std::string, ChildProgram> m_running;
  std::vector<std::string> m_end_with_this;  ///< titles
  std::map<std::string, std::string> m_outputs;
  std::string m_news;
  bool m_refused = false, m_fresh = false;
  double m_news_since = 0;
};

/// The last lines of a program's messages, without times and levels of a log.
std::string last_lines(const std::string& text, std::size_t most);

}  // namespace trocar::app
