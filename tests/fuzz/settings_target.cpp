// The settings reader. It takes what is right and leaves the rest, so whatever comes out must be within the limits.
#include <trocar/attempt/paths.hpp>
#include <trocar/training/store/attempt.hpp>

#include "archive.hpp"
#include "shell/settings.hpp"
#include "targets.hpp"

namespace trocar::app {

// What only writing to the disk would need of the program.
void make_folder(const std::filesystem::path&) {}
std::filesystem::path data_folder() { return {}; }

}  // namespace trocar::app

namespace trocar::fuzz {
namespace {

app::Settings read(const std::string& text, std::vector<core::Fault>& faults) {
  const scene::MemoryFiles files{{"settings.json", text}};
  return app::read_settings("settings.json", faults, &files);
}

bool within(double value, double least, double most) { return value >= least && value <= most; }

}  // namespace

void settings_file(Bytes bytes) {
  std::vector<core::Fault> faults;
  const app::Settings s = read(text_of(bytes), faults);
  for (double sense : {s.mouse, s.wheel, s.keyboard, s.gamepad})
    require(within(sense, app::kLeastSense, app::kMostSense), "sensitivities are within their limits");
  require(within(s.volume, 0, 1) && within(s.text_size, app::kLeastText, app::kMostText), "so are volume and text");
  require(s.window_width >= app::kLeastWidth && s.window_width <= app::kMostPixels, "so is the window's width");
  require(s.window_height >= app::kLeastHeight && s.window_height <= app::kMostPixels, "and its height");
  require(s.trainee.size() <= training::kLongestName && training::clean_name(s.trainee) == s.trainee,
          "a name may be shown");
  faults.clear();
  const app::Settings again = read(app::settings_text(s), faults);
  require(faults.empty() && again == s, "what was read can be written and read again");
}

std::vector<Seed> settings_seeds() {
  app::Settings other;
  other.left_handed = other.mirrored_picture = true;
  other.trainee = "Ada \xc3\xa4";
  other.mouse = 2.5;
  other.others = {{"Bob", {}}};
  return {{"defaults", bytes_of(app::settings_text({}))}, {"other", bytes_of(app::settings_text(other))}};
}

}  // namespace trocar::fuzz
