#include <chrono>
#include <exception>

#include <trocar/attempt/lesson_shelf.hpp>

namespace trocar::attempt {

void LessonShelf::want(const std::string& exercise, std::uint64_t seed) {
  if (m_wanted == Order{exercise, seed}) return;
  m_wanted = {exercise, seed};
  m_failure.clear();
  if (!m_future.valid()) begin();
}

void LessonShelf::begin() {
  m_lesson.reset();
  m_loading = m_wanted;
  m_future = std::async(std::launch::async, [order = m_wanted] { return load_lesson(order.exercise, order.seed); });
}

const Lesson* LessonShelf::poll() {
  if (m_future.valid() && m_future.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    try {
      m_lesson = m_future.get();
    } catch (const std::exception& fault) {  // told on the screen
      if (m_loading == m_wanted) m_failure = fault.what();
    }
    if (m_loading != m_wanted) begin();
  }
  return m_lesson && m_wanted == Order{m_lesson->name, m_lesson->seed} ? m_lesson.get() : nullptr;
}

}  // namespace trocar::attempt
