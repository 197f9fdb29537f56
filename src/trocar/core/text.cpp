#include <trocar/core/text.hpp>

namespace trocar {
namespace {

Translator installed_translator = nullptr;

}  // namespace

void set_translator(Translator translator) { installed_translator = translator; }

const char* tr(const char* text) { return installed_translator ? installed_translator(text) : text; }

std::string detail::format_translated(const char* format, fmt::format_args arguments) {
  const char* translated = tr(format);
  if (translated == format) return fmt::vformat(format, arguments);
  try {
    return fmt::vformat(translated, arguments);
  } catch (const fmt::format_error&) {
    return fmt::vformat(format, arguments);
  }
}

}  // namespace trocar
