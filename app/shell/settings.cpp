#include "shell/settings.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/training/store/store.hpp>

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

namespace keys = scene::keys;

constexpr const char* kOff = "off";

std::vector<std::string> second_window_names() {
  std::vector<std::string> names = names_in(kPaneNames);
  names.insert(names.begin(), kOff);
  return names;
}

std::vector<scene::Key> person_keys() {
  return {keys::flag("left_handed", "mouse buttons, gamepad sides, order of the hands"),
          keys::flag("both_hands", "two instruments are controlled at once"),
          keys::number("mouse", kLeastSense, kMostSense, "sensitivity"),
          keys::number("wheel", kLeastSense, kMostSense, "sensitivity"),
          keys::number("keyboard", kLeastSense, kMostSense, "sensitivity"),
          keys::number("gamepad", kLeastSense, kMostSense, "sensitivity"),
          keys::flag("invert_x", "instrument moves against the hand, sideways"),
          keys::flag("invert_y", "instrument moves against the hand, up and down"),
          keys::flag("invert_view_x", "endoscope, sideways"),
          keys::flag("invert_view_y", "endoscope, up and down"),
          keys::flag("mirrored_picture", "left and right of the picture exchanged"),
          keys::flag("show_hint", "the three things to know, before an attempt")};
}

const scene::Shape& person_shape() {
  static const scene::Shape shape = [] {
    scene::Shape person{"person", "Settings of somebody who has practised at this machine.", person_keys()};
    person.keys.insert(person.keys.begin(), scene::needed(keys::text("name", "of the person")));
    return person;
  }();
  return shape;
}

const scene::Shape& settings_shape() {
  static const scene::Shape shape = [] {
    scene::Shape settings{
        "settings",
        "Settings of the machine and of its people.",
        {scene::needed(keys::format(1)),
         keys::choice("stereo", pictures::stereo_names(), "pictures for two eyes"),
         keys::number("eye_distance_mm", pictures::kLeastBase, pictures::kMostBase, "between the two eyes"),
         keys::number("convergence_mm", pictures::kLeastConvergence, pictures::kMostConvergence,
                      "from the lens to the depth of the screen"),
         keys::flag("swap_eyes", "left and right eye swapped"),
         keys::choice("layout", names_in(kLayoutNames), "of the window's panes"),
         keys::choice("pane_1", names_in(kPaneNames), "what the first pane shows"),
         keys::choice("pane_2", names_in(kPaneNames), "the second"),
         keys::choice("pane_3", names_in(kPaneNames), "the third"),
         keys::choice("pane_4", names_in(kPaneNames), "the fourth"),
         keys::choice("second_window", second_window_names(), "what the window for a second screen shows"),
         keys::number("volume", 0, 1, "of sounds"),
         keys::flag("force_trace", "the force on the controlled hand is drawn"),
         keys::flag("force_sound", "it is heard"),
         keys::flag("rumble", "it is felt, where a gamepad has motors"),
         keys::number("text_size", kLeastText, kMostTextEver, "of all texts"),
         keys::integer("window_width", kLeastWidth, kMostPixels, "[px]"),
         keys::integer("window_height", kLeastHeight, kMostPixels, "[px]"),
         keys::text("trainee", "who is at the machine: the settings of hands, directions and hints are this person's"),
         keys::objects("people", person_shape, 0, "everybody else who has practised here")}};
    for (scene::Key& key : person_keys()) settings.keys.push_back(std::move(key));
    return settings;
  }();
  return shape;
}

constexpr const char* kPaneKeys[kMostPanes] = {"pane_1", "pane_2", "pane_3", "pane_4"};

/// Panes that name the same thing twice are put right: what is named last gives way.
LayoutChoice read_views(const scene::JsonObject& o) {
  LayoutChoice views;
  views.layout = Layout(number_of(kLayoutNames, o.text("layout", name_of(views.layout))));
  for (int i = kMostPanes - 1; i >= 0; --i) {
    const PaneShows usual = views.panes[std::size_t(i)];
    views.put(i, PaneShows(number_of(kPaneNames, o.text(kPaneKeys[i], name_of(usual)))));
  }
  const std::string elsewhere = o.text("second_window", kOff);
  if (elsewhere != kOff) views.elsewhere = PaneShows(number_of(kPaneNames, elsewhere));
  return views;
}

PersonSettings read_person(const scene::JsonObject& o) {
  PersonSettings p;
  p.left_handed = o.flag("left_handed", p.left_handed);
  p.both_hands = o.flag("both_hands", p.both_hands);
  p.mouse = o.number("mouse", p.mouse);
  p.wheel = o.number("wheel", p.wheel);
  p.keyboard = o.number("keyboard", p.keyboard);
  p.gamepad = o.number("gamepad", p.gamepad);
  p.invert_x = o.flag("invert_x", p.invert_x);
  p.invert_y = o.flag("invert_y", p.invert_y);
  p.invert_view_x = o.flag("invert_view_x", p.invert_view_x);
  p.invert_view_y = o.flag("invert_view_y", p.invert_view_y);
  p.mirrored_picture = o.flag("mirrored_picture", p.mirrored_picture);
  p.show_hint = o.flag("show_hint", p.show_hint);
  return p;
}

Json person_json(const PersonSettings& p) {
  return {{"left_handed", p.left_handed},
          {"both_hands", p.both_hands},
          {"mouse", p.mouse},
          {"wheel", p.wheel},
          {"keyboard", p.keyboard},
          {"gamepad", p.gamepad},
          {"invert_x", p.invert_x},
          {"invert_y", p.invert_y},
          {"invert_view_x", p.invert_view_x},
          {"invert_view_y", p.invert_view_y},
          {"mirrored_picture", p.mirrored_picture},
          {"show_hint", p.show_hint}};
}

auto person_named(std::vector<KnownPerson>& people, const std::string& name) {
  return std::find_if(people.begin(), people.end(), [&name](const KnownPerson& p) { return p.name == name; });
}

/// Each name once, without the one who is at the machine.
std::vector<KnownPerson> read_others(const scene::JsonObject& o, const std::string& here) {
  std::vector<KnownPerson> others;
  for (const scene::JsonObject& p : o.objects("people")) {
    const std::string name = training::clean_name(p.text("name"));
    if (name.empty() || name == here || others.size() >= kMostPeople) continue;
    if (person_named(others, name) == others.end()) others.push_back({name, read_person(p)});
  }
  return others;
}

}  // namespace

fs::path settings_file() { return attempt::data_folder() / "settings.json"; }

Settings read_settings(const fs::path& file, std::vector<core::Fault>& faults, const scene::MemoryFiles* memory) {
  Settings s;
  std::error_code error;
  if (!memory && !fs::exists(file, error)) return s;
  const scene::JsonDocument document = scene::load_json(file, faults, memory);
  const scene::JsonObject o(document.root, settings_shape(), document.file, faults);
  static_cast<PersonSettings&>(s) = read_person(o);
  s.stereo = o.text("stereo", s.stereo);
  s.eye_distance = o.number("eye_distance_mm", s.eye_distance);
  s.convergence = o.number("convergence_mm", s.convergence);
  s.swap_eyes = o.flag("swap_eyes", s.swap_eyes);
  s.views = read_views(o);
  s.volume = o.number("volume", s.volume);
  s.force_trace = o.flag("force_trace", s.force_trace);
  s.force_sound = o.flag("force_sound", s.force_sound);
  s.rumble = o.flag("rumble", s.rumble);
  s.text_size = std::min(o.number("text_size", s.text_size), kMostText);
  s.window_width = o.integer("window_width", s.window_width);
  s.window_height = o.integer("window_height", s.window_height);
  s.trainee = training::clean_name(o.text("trainee"));
  s.others = read_others(o, s.trainee);
  return s;
}

std::string settings_text(const Settings& s) {
  Json json{{"format", 1}, {"trainee", s.trainee}};
  json.update(person_json(s));
  json.update({{"stereo", s.stereo},
               {"eye_distance_mm", s.eye_distance},
               {"convergence_mm", s.convergence},
               {"swap_eyes", s.swap_eyes},
               {"layout", name_of(s.views.layout)},
               {"pane_1", name_of(s.views.panes[0])},
               {"pane_2", name_of(s.views.panes[1])},
               {"pane_3", name_of(s.views.panes[2])},
               {"pane_4", name_of(s.views.panes[3])},
               {"second_window", s.views.elsewhere ? name_of(*s.views.elsewhere) : kOff},
               {"volume", s.volume},
               {"force_trace", s.force_trace},
               {"force_sound", s.force_sound},
               {"rumble", s.rumble},
               {"text_size", s.text_size},
               {"window_width", s.window_width},
               {"window_height", s.window_height}});
  Json people = Json::array();
  for (const KnownPerson& p : s.others) {
    people.push_back({{"name", p.name}});
    people.back().update(person_json(p.settings));
  }
  json["people"] = people;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_settings(const fs::path& file, const Settings& settings) {
  training::make_own_folder(file.parent_path());  // the data folder: names are nobody else's business
  attempt::make_folder(file.parent_path());
  const std::string text = settings_text(settings);
  if (core::write_file(file, {text}).empty()) return;
  throw core::EnvironmentLacks(
      tr("cannot write {}: make room or allow writing; the settings hold until the end", file.string()));
}

bool forget_in_settings(const fs::path& file, const std::string& trainee) {
  std::vector<core::Fault> ignored;
  Settings s = read_settings(file, ignored);
  const auto other = person_named(s.others, trainee);
  const bool here = !s.trainee.empty() && s.trainee == trainee;
  if (!here && other == s.others.end()) return false;
  if (here) s.trainee.clear();
  if (other != s.others.end()) s.others.erase(other);
  write_settings(file, s);
  return true;
}

void choose_person(Settings& s, const std::string& name) {
  if (name == s.trainee) return;
  if (!s.trainee.empty()) s.others.insert(s.others.begin(), {s.trainee, s});
  PersonSettings chosen;
  if (const auto known = person_named(s.others, name); known != s.others.end()) {
    chosen = known->settings;
    s.others.erase(known);
  }
  if (s.others.size() > kMostPeople) s.others.resize(kMostPeople);
  static_cast<PersonSettings&>(s) = chosen;
  s.trainee = name;
}

Directions directions_of(const PersonSettings& p) {
  const int turned = int(p.invert_x) + int(p.invert_y) + int(p.invert_view_x) + int(p.invert_view_y);
  return turned == 4 ? Directions::theatre : turned == 0 ? Directions::screen : Directions::custom;
}

void set_directions(PersonSettings& p, Directions directions) {
  if (directions == Directions::custom) return;
  p.invert_x = p.invert_y = p.invert_view_x = p.invert_view_y = directions == Directions::theatre;
}

void reset_settings(Settings& s) {
  Settings fresh;
  fresh.trainee = std::move(s.trainee);
  fresh.others = std::move(s.others);
  s = std::move(fresh);
}

pictures::TwoEyes two_eyes(const Settings& s) {
  pictures::TwoEyes eyes;
  for (const pictures::StereoName& known : pictures::kStereoNames)
    if (s.stereo == known.name) eyes.mode = known.mode;
  eyes.eyes = {float(1e-3 * s.eye_distance), float(1e-3 * s.convergence)};
  eyes.swapped = s.swap_eyes;
  return eyes;
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
