// Says on stderr what a command is at, once it has taken a second, and every other second from then on.
//
//   ProgressNotice notice("scene.json");
//   notice.at("compiling");
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace trocar::app {

class ProgressNotice {
 public:
  explicit ProgressNotice(std::string what);
  ~ProgressNotice();
  ProgressNotice(const ProgressNotice&) = delete;
  ProgressNotice& operator=(const ProgressNotice&) = delete;

  void at(const std::string& stage);

 private:
  void tell();

  std::mutex m_lock;
  std::condition_variable m_ends;
  std::string m_what, m_stage;
  bool m_over = false;
  std::thread m_thread;  // last: it uses the others
};

}  // namespace trocar::app
