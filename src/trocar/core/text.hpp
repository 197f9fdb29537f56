#pragma once
// Every text that a user reads passes through tr(): labels, hints, messages, reports. It returns the text in the user's
// language, or as written where no translation is installed. A sentence is one text; it is never put together from
// parts.
//
//   ui::text(tr("Paused"));
//   ui::text(tr("{} of {} points", score, maximum));  // the format is checked when it is compiled

#include <string>

#include <fmt/format.h>

namespace trocar {

/// Returns the translation of a text, or the same pointer where there is none. What it returns lives as long as the
/// program.
using Translator = const char* (*)(const char* text);

/// Call once, before the first text is shown; null removes the translator. Not thread-safe.
void set_translator(Translator translator);

/// The text in the user's language.
const char* tr(const char* text);

namespace detail {
/// The translated format with its arguments; where the translation's fields do not fit them, the original format.
std::string format_translated(const char* format, fmt::format_args arguments);
}  // namespace detail

/// The same with fields in braces, as fmt::format has them.
template <class First, class... Rest>
std::string tr(fmt::format_string<First, Rest...> format, First&& first, Rest&&... rest) {
  return detail::format_translated(fmt::string_view(format).data(), fmt::make_format_args(first, rest...));
}

}  // namespace trocar
