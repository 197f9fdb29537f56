#include "settings.hpp"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include <trocar/scene/shape.hpp>

#include "json.hpp"
#include "paths.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

namespace keys = scene::keys;

const scene::Shape& settings_shape() {
  static const scene::Shape shape{
      "settings",
      "What a person has chosen for the trainer's window.",
      {scene::needed(keys::format(1)), keys::flag("left_handed", "mouse buttons, gamepad sides, order of the hands"),
       keys::number("mouse", kLeastSense, kMostSense, "sensitivity"),
       keys::number("wheel", kLeastSense, kMostSense, "sensitivity"),
       keys::number("keyboard", kLeastSense, kMostSense, "sensitivity"),
       keys::number("gamepad", kLeastSense, kMostSense, "sensitivity"),
       keys::flag("invert_x", "instrument moves against the hand, sideways"),
       keys::flag("invert_y", "instrument moves against the hand, up and down"),
       keys::flag("invert_view_x", "endoscope, sideways"), keys::flag("invert_view_y", "endoscope, up and down"),
       keys::flag("mirrored_picture", "left and right of the picture exchanged"),
       keys::number("volume", 0, 1, "of sounds"), keys::number("text_size", kLeastText, kMostText, "of all texts"),
       keys::integer("window_width", kLeastWidth, kMostPixels, "[px]"),
       keys::integer("window_height", kLeastHeight, kMostPixels, "[px]"), keys::text("trainee", "the last one"),
       keys::flag("show_hint", "the three things to know, before an attempt")}};
  return shape;
}

/// One byte sequence of UTF-8 at the front of `text`: its length, 0 where there is none.
std::size_t character_length(std::string_view text) {
  const unsigned char first = static_cast<unsigned char>(text[0]);
  const std::size_t n = first < 0x80                    ? 1
                        : first >= 0xC2 && first < 0xE0 ? 2
                        : first >= 0xE0 && first < 0xF0 ? 3
                        : first >= 0xF0 && first < 0xF5 ? 4
                                                        : 0;
  if (n == 0 || n > text.size()) return 0;
  for (std::size_t i = 1; i < n; ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) return 0;
  return n;
}

}  // namespace

fs::path settings_file() { return data_folder() / "settings.json"; }

std::string proper_name(const std::string& typed) {
  std::string name;
  std::string_view rest = typed;
  while (!rest.empty()) {
    const std::size_t n = character_length(rest);
    const bool printable = n > 1 || (n == 1 && rest[0] >= ' ' && rest[0] != 0x7F);
    if (printable && name.size() + n <= kLongestName && !(name.empty() && rest[0] == ' ')) name += rest.substr(0, n);
    rest.remove_prefix(std::max<std::size_t>(n, 1));
  }
  while (!name.empty() && name.back() == ' ') name.pop_back();
  return name;
}

Settings read_settings(const fs::path& file, std::vector<core::Fault>& faults, const scene::MemoryFiles* memory) {
  Settings s;
  std::error_code error;
  if (!memory && !fs::exists(file, error)) return s;
  const scene::JsonDocument document = scene::load_json(file, faults, memory);
  const scene::JsonObject o(document.root, settings_shape(), document.file, faults);
  s.left_handed = o.flag("left_handed", s.left_handed);
  s.mouse = o.number("mouse", s.mouse);
  s.wheel = o.number("wheel", s.wheel);
  s.keyboard = o.number("keyboard", s.keyboard);
  s.gamepad = o.number("gamepad", s.gamepad);
  s.invert_x = o.flag("invert_x", s.invert_x);
  s.invert_y = o.flag("invert_y", s.invert_y);
  s.invert_view_x = o.flag("invert_view_x", s.invert_view_x);
  s.invert_view_y = o.flag("invert_view_y", s.invert_view_y);
  s.mirrored_picture = o.flag("mirrored_picture", s.mirrored_picture);
  s.volume = o.number("volume", s.volume);
  s.text_size = o.number("text_size", s.text_size);
  s.window_width = o.integer("window_width", s.window_width);
  s.window_height = o.integer("window_height", s.window_height);
  s.trainee = proper_name(o.text("trainee"));
  s.show_hint = o.flag("show_hint", s.show_hint);
  return s;
}

std::string settings_text(const Settings& s) {
  const Json json{{"format", 1},
                  {"left_handed", s.left_handed},
                  {"mouse", s.mouse},
                  {"wheel", s.wheel},
                  {"keyboard", s.keyboard},
                  {"gamepad", s.gamepad},
                  {"invert_x", s.invert_x},
                  {"invert_y", s.invert_y},
                  {"invert_view_x", s.invert_view_x},
                  {"invert_view_y", s.invert_view_y},
                  {"mirrored_picture", s.mirrored_picture},
                  {"volume", s.volume},
                  {"text_size", s.text_size},
                  {"window_width", s.window_width},
                  {"window_height", s.window_height},
                  {"trainee", s.trainee},
                  {"show_hint", s.show_hint}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_settings(const fs::path& file, const Settings& settings) {
  make_folder(file.parent_path());
  fs::path fresh = file;
  fresh += fmt::format(".{}.new", getpid());  // two programs at once write two files
  const std::string text = settings_text(settings);
  std::FILE* out = std::fopen(fresh.c_str(), "w");
  bool good = out && std::fwrite(text.data(), 1, text.size(), out) == text.size();
  good = good && std::fflush(out) == 0 && fsync(fileno(out)) == 0;
  if (out) good = std::fclose(out) == 0 && good;
  std::error_code error;
  if (good) fs::rename(fresh, file, error);
  if (good && !error) return;
  std::error_code ignored;
  fs::remove(fresh, ignored);
  throw core::EnvironmentLacks(
      fmt::format("cannot write {}: make room or allow writing; the settings hold until the end", file.string()));
}

devices::HandSettings hand_settings(const Settings& s, int instruments) {
  devices::HandSettings h;
  h.instruments = instruments;
  h.metres_per_pixel *= float(s.mouse);
  h.view_per_pixel *= float(s.mouse);
  h.roll_per_pixel *= float(s.mouse);
  h.metres_per_notch *= float(s.wheel);
  h.key_speed *= float(s.keyboard);
  h.key_view *= float(s.keyboard);
  h.roll_per_second *= float(s.keyboard);
  h.stick_speed *= float(s.gamepad);
  h.stick_roll *= float(s.gamepad);
  h.stick_view *= float(s.gamepad);
  h.left_handed = s.left_handed;
  h.invert_x = s.invert_x;
  h.invert_y = s.invert_y;
  h.invert_view_x = s.invert_view_x;
  h.invert_view_y = s.invert_view_y;
  return h;
}

}  // namespace trocar::app
