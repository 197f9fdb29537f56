#include "commands/progress_notice.hpp"

#include <chrono>
#include <utility>

#include <trocar/core/log.hpp>

namespace trocar::app {

ProgressNotice::ProgressNotice(std::string what) : m_what(std::move(what)), m_thread([this] { tell(); }) {}

ProgressNotice::~ProgressNotice() {
  {
    const std::lock_guard lock(m_lock);
    m_over = true;
  }
  m_ends.notify_one();
  m_thread.join();
}

void ProgressNotice::at(const std::string& stage) {
  const std::lock_guard lock(m_lock);
  m_stage = stage;
}

void ProgressNotice::tell() {
  std::unique_lock lock(m_lock);
  for (int seconds = 1; !m_ends.wait_for(lock, std::chrono::seconds(seconds == 1 ? 1 : 2), [this] { return m_over; });
       seconds += 2)
    core::log::info("{}: {} ({} s so far)", m_what, m_stage, seconds);
}

}  // namespace trocar::app
