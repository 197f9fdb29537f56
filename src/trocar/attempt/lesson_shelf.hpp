// The lesson that is wanted next, prepared on a thread of its own while the start screen is shown: reading and
// compiling a scene takes seconds.
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <string>

#include <trocar/attempt/lesson.hpp>

namespace trocar::attempt {

class LessonShelf {
 public:
  /// Puts a lesson there that is ready already. May be null.
  explicit LessonShelf(std::unique_ptr<Lesson> lesson) : m_lesson(std::move(lesson)) {
    if (m_lesson) m_wanted = {m_lesson->name, m_lesson->seed};
  }

  /// @param seed  of the anatomy, as load_lesson()
  void want(const std::string& exercise, std::uint64_t seed);
  /// The wanted lesson when it is ready, else null. Once per picture. A lesson stays where it is until another is
  /// wanted.
  const Lesson* poll();
  const std::string& wanted() const { return m_wanted.exercise; }
  std::uint64_t seed() const { return m_wanted.seed; }      ///< of the wanted one
  const std::string& failure() const { return m_failure; }  ///< why the wanted one cannot be prepared

 private:
  struct Order {
    std::string exercise;
    std::uint64_t seed = 0;
    bool operator==(const Order&) const = default;
  };
  void begin();

  Order m_wanted, m_loading;
  std::string m_failure;
  std::unique_ptr<Lesson> m_lesson;
  std::future<std::unique_ptr<Lesson>> m_future;
};

}  // namespace trocar::attempt
