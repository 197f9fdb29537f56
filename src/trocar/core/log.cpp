#include <atomic>
#include <memory>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <trocar/core/log.hpp>

namespace trocar::core::log {
namespace {

std::atomic<Level> g_level{Level::info};

spdlog::level::level_enum spdlog_level(Level level) {
  switch (level) {
    case Level::debug:
      return spdlog::level::debug;
    case Level::info:
      return spdlog::level::info;
    case Level::warn:
      return spdlog::level::warn;
    case Level::error:
      return spdlog::level::err;
    case Level::off:
      break;
  }
  return spdlog::level::off;
}

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    auto made = std::make_shared<spdlog::logger>("trocar", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    made->set_pattern("trocar: %^%l%$: %v");
    made->set_level(spdlog::level::trace);
    made->flush_on(spdlog::level::trace);
    return made;
  }();
  return *instance;
}

}  // namespace

void set_level(Level level) { g_level = level; }
Level level() { return g_level; }

void write(Level at, fmt::string_view message) {
  if (at == Level::off || at < level()) return;
  logger().log(spdlog_level(at), spdlog::string_view_t(message.data(), message.size()));
}

}  // namespace trocar::core::log
