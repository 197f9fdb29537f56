// Messages for people, on standard error (standard output belongs to results). Not for the step: it reports flags.
//   log::info("compiled {} in {:.1f} ms", name, ms);
#pragma once

#include <utility>

#include <fmt/core.h>

#include <trocar/core/text.hpp>

namespace trocar::core::log {

enum class Level { debug, info, warn, error, off };

/// Messages below `level` are dropped; the start value is `info`.
void set_level(Level level);
Level level();

/// One line, already formatted; the functions below are how it is usually called.
void write(Level level, fmt::string_view message);

namespace detail {
template <class... Args>
void write_formatted(Level at, fmt::format_string<Args...> format, Args&&... args) {
  if (at >= level())
    write(at, trocar::detail::format_translated(fmt::string_view(format).data(), fmt::make_format_args(args...)));
}
}  // namespace detail

template <class... Args>
void debug(fmt::format_string<Args...> format, Args&&... args) {
  detail::write_formatted<Args...>(Level::debug, format, std::forward<Args>(args)...);
}
template <class... Args>
void info(fmt::format_string<Args...> format, Args&&... args) {
  detail::write_formatted<Args...>(Level::info, format, std::forward<Args>(args)...);
}
template <class... Args>
void warn(fmt::format_string<Args...> format, Args&&... args) {
  detail::write_formatted<Args...>(Level::warn, format, std::forward<Args>(args)...);
}
template <class... Args>
void error(fmt::format_string<Args...> format, Args&&... args) {
  detail::write_formatted<Args...>(Level::error, format, std::forward<Args>(args)...);
}

}  // namespace trocar::core::log
