// trocar gallery: the picture book. Every scene through its endoscope, close up (organs, what is mistaken for what),
// every instrument, an exchange, how a shadow tells height, clips and a cut, coagulation, smoke and the fogged lens,
// bleeding, figures in colour, ways to show parts, both eyes, and from outside.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/text.hpp>
#include <trocar/pictures/camera_choice.hpp>
#include <trocar/pictures/pictures.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/stages/visibility.hpp>

#include "commands/command.hpp"
#include "commands/gallery/gallery_events.hpp"
#include "commands/gallery/gallery_names.hpp"

namespace trocar::app {
namespace {

using view::ViewOptions;

Vec3d on_strand(const sim::Model& model, const sim::State& state, int strand, double s) {
  const interactions::StrandBody& body = model.strand_bodies[std::size_t(strand)];
  return point_at(body, state.strands[std::size_t(strand)], place_at(body, s));
}

/// From 75 mm, or so far that no part of the organ is nearer to the lens than its picture can bear.
ViewOptions close_up_of(const sim::Model& model, const std::vector<Vec3d>& skin) {
  constexpr double kDistance = 0.075, kNearest = 0.045;  // [m]
  Vec3d middle{};
  for (Vec3d p : skin) middle += p / double(skin.size());
  const Vec3d eye = close_up(model, middle, kDistance).eye;
  const double gap = length(nearest(skin, eye) - eye);
  return close_up(model, middle, kDistance + std::max(0.0, kNearest - gap));
}

void organs(const sim::Model& model, const sim::State& start, pictures::Shots& shots) {
  for (int i = 0; i < model.organs(); ++i) {
    const std::string& name = model.organ_name(i);
    shots.take_outside(start, name, fmt::format("{}, close up", name), close_up_of(model, skin_of(model, i)));
  }
}

/// Along each tube: where it leaves its organ among cords that look like it, its middle, and its open end.
void tubes(const sim::Model& model, const sim::State& start, pictures::Shots& shots) {
  for (int i = 0; i < int(model.strands.size()); ++i) {
    const sim::StrandAnatomy& strand = model.strands[std::size_t(i)];
    if (!strand.fimbriated) continue;
    const double length = model.strand_bodies[std::size_t(i)].length();
    const auto take = [&](double s, double distance, const std::string& what, const std::string& text) {
      shots.take_outside(start, strand.name + " " + what, strand.name + ": " + text,
                         close_up(model, on_strand(model, start, i, s), distance));
    };
    take(0.1 * length, 0.05, "look-alikes",
         "the tube between round ligament (before it) and ovarian ligament (behind)");
    take(0.45 * length, 0.065, "fold", "the fold below it with its vessels");
    take(0.98 * length, 0.045, "fimbria", "its open end");
  }
}

constexpr double kToTool = 0.075;  // [m] near, with some of what is around it

/// Each instrument once, half open, from the side.
void instruments(const sim::Model& model, const sim::State& start, pictures::Shots& shots) {
  std::vector<std::string> shown;
  for (std::size_t h = 0; h < model.hands.size(); ++h)
    for (std::size_t i = 0; i < model.hands[h].rack.size(); ++i) {
      const interactions::ToolModel& tool = model.hands[h].rack[i];
      if (std::find(shown.begin(), shown.end(), tool.name) != shown.end()) continue;
      shown.push_back(tool.name);
      sim::State state = start;
      state.tools[h].instrument = int(i);
      state.tools[h].clips_left = tool.clips;
      state.tools[h].armed = 1;
      state.tools[h].aperture = 0.6;
      const interactions::ToolShape shape = shape_of(tool, state.tools[h].pose(), 0.6);
      ViewOptions options = close_up(model, shape.pivot, kToTool);
      const Vec3d axis = shape.frame.axis(), off = options.eye - shape.pivot;
      options.eye = shape.pivot + kToTool * normalised(off - dot(off, axis) * axis, shape.frame.normal());
      shots.take_outside(state, tool.name, tool.name, options);
    }
}

/// A hand changes its instrument: drawn back, changed at the trocar, and in again.
void exchange(const sim::Model& model, const sim::State& start, pictures::Shots& shots) {
  const auto hand =
      std::find_if(model.hands.begin(), model.hands.end(), [](const auto& h) { return h.rack.size() > 1; });
  if (hand == model.hands.end()) return;
  const auto h = std::size_t(hand - model.hands.begin());
  sim::State state = start;
  sim::Work work = sim::make_work(model);
  sim::Input input = model.start;
  input.tools[h].instrument = 1;
  const kinematics::TipFrame tip = kinematics::forward(hand->port, start.tools[h].pose());
  const Vec3d entry = hand->port + 0.045 * tip.axis();
  const auto take = [&](const std::string& what) {
    ViewOptions options = close_up(model, entry, 0.07);
    shots.take_outside(state, "exchange " + what, tr("{}: instrument exchange, {}", hand->name, what), options);
  };
  take("before");
  constexpr int kLongest = 8000;
  int tick = 0;
  for (; tick < kLongest && state.tools[h].changes == start.tools[h].changes; ++tick)
    sim::step(model, input, state, work);
  take("at the trocar");
  for (int i = 0; i < 400; ++i) sim::step(model, input, state, work);
  take("in again");
  for (int i = 0; i < 3000; ++i) sim::step(model, input, state, work);
  shots.take(state, "exchanged", "through the endoscope, after the exchange");
}

/// The first hand's instrument, closed, at three heights over the first organ: its shadow parts from it.
void heights(const sim::Model& model, const sim::State& start, pictures::Shots& shots) {
  if (model.hands.empty() || model.organs() == 0) return;
  const kinematics::ScopeFrame scope = sim::scope_of(model, start);
  const Vec3d place = nearest(skin_of(model, 0), scope.eye), towards = normalised(scope.eye - place);
  for (const double above : {0.025, 0.008, -0.002}) {
    sim::State state = start;
    sim::Work work = sim::make_work(model);
    sim::Input input = model.start;
    const kinematics::FulcrumPose pose =
        kinematics::inverse(model.hands[0].port, place + above * towards, double(input.tools[0].roll));
    input.tools[0] = sim::tool_input(pose, 1);
    for (int i = 0; i < 1200; ++i) sim::step(model, input, state, work);
    const std::string name =
        above > 0 ? fmt::format("{:.0f} mm", 1e3 * above) + " above an organ" : "touching an organ";
    shots.take(state, "height " + name, "an instrument " + name);
  }
}

/// Two clips on the first tube that can be cut, then a cut between them.
void clips_and_cut(const sim::Model& model, const sim::State& start, pictures::Shots& shots) {
  const auto tube =
      std::find_if(model.strands.begin(), model.strands.end(), [](const auto& s) { return s.fimbriated; });
  double clip_length = 0;
  for (const sim::HandModel& hand : model.hands)
    for (const interactions::ToolModel& tool : hand.rack) clip_length = std::max(clip_length, tool.clip_length);
  if (tube == model.strands.end() || clip_length <= 0) return;
  const int strand = int(tube - model.strands.begin());
  sim::State state = start;
  for (const double s : {0.017, 0.025}) {
    interactions::Clip& clip = state.clips[std::size_t(state.clip_count++)];
    clip.strand = strand;
    clip.s = s;
    clip.cover = 1;
    clip.opening[1] = 1;
    clip.axis[2] = 1;
    clip.length = clip_length;
    clip.reach = 0.5 * clip_length;
  }
  const ViewOptions options = close_up(model, on_strand(model, start, strand, 0.021), 0.04);
  shots.take_outside(state, "clips", "two clips on the isthmus", options);
  interactions::Cut& cut = state.cuts[std::size_t(state.cut_count++)];
  cut.strand = strand;
  cut.s = 0.021;
  cut.fraction = 1;
  const int element = place_at(model.strand_bodies[std::size_t(strand)], cut.s).element;
  tissue::cut_element(state.strands[std::size_t(strand)], element);
  std::vector<Vec3d>& x = state.strands[std::size_t(strand)].x;
  for (std::size_t i = std::size_t(element) + 1; i < x.size(); ++i) {  // the ends draw apart
    const double fade = std::max(0.0, 1 - 0.2 * double(i) + 0.2 * (element + 1));
    x[i] += 0.004 * fade * normalised(x[std::size_t(element) + 1] - x[std::size_t(element)]);
  }
  shots.take_outside(state, "cut", "cut between them", options);
}

/// Three places along the edge of an organ that is nearest to a port, `apart` [m] from each other.
std::array<Vec3d, 3> places_along_edge(const std::vector<Vec3d>& skin, Vec3d port, double apart) {
  const Vec3d middle = nearest(skin, port), side = normalised(cross(middle - port, Vec3d{0, 0, 1}), {1, 0, 0});
  std::array<Vec3d, 3> places;
  for (int k = 0; k < 3; ++k) {
    const Vec3d want = middle + (k - 1) * apart * side;
    const auto off = [&](Vec3d p) { return length(p - port) + 4 * std::fabs(dot(p - want, side)); };
    places[std::size_t(k)] =
        *std::min_element(skin.begin(), skin.end(), [&](Vec3d p, Vec3d q) { return off(p) < off(q); });
  }
  return places;
}

/// Scissors cut three times into the edge of each organ that can be cut; then they draw back.
void bites(const sim::Model& model, const sim::State& start, pictures::Shots& shots) {
  constexpr double kApart = 0.016;  // [m]
  for (std::size_t h = 0; h < model.hands.size(); ++h) {
    const interactions::ToolModel& tool = model.placed(h);
    if (tool.kind != interactions::ToolKind::scissors) continue;
    sim::visit_cuttables(model, [&](auto body) {
      const int organ = int(body.organ());
      sim::State state = start;
      sim::Work work = sim::make_work(model);
      sim::Input input = model.start;
      const Vec3d port = model.hands[h].port;
      const auto go = [&](Vec3d edge, double beyond, double handle, int ticks) {
        const Vec3d tip = edge + beyond * normalised(edge - port);
        input.tools[h] = sim::tool_input(kinematics::inverse(port, tip, double(input.tools[h].roll)), float(handle));
        for (int i = 0; i < ticks; ++i) sim::step(model, input, state, work);
      };
      const std::string& name = model.organ_name(organ);
      const std::array<Vec3d, 3> places = places_along_edge(skin_of(model, organ), port, kApart);
      const ViewOptions options = close_up(model, places[1], 0.07);
      for (const Vec3d& edge : places) {
        go(edge, -0.02, 0, 600);
        go(edge, 0.008, 0, 500);
        if (&edge == &places[0])
          shots.take_outside(state, name + " between blades", name + " between open blades", options);
        for (const double deep : {0.008, 0.014}) {
          go(edge, deep, 0, 300);
          go(edge, deep, 1, 300);
          go(edge, deep, 0, 200);
        }
        go(edge, -0.03, 0, 500);
      }
      go(places[1], -0.04, 1, 1500);
      shots.take_outside(state, name + " cut", name + ", cut three times", options);
      shots.take(state, name + " cut endoscope", "the same through the endoscope");
    });
  }
}

void outside(const sim::Model& model, const sim::State& start, pictures::Shots& shots) {
  const view::Orbit around = view::orbit_around(model);
  for (const pictures::CameraPreset& preset : pictures::kCameraPresets) {
    ViewOptions options = view_of(pictures::choice_of(preset), around);
    options.walls = false;
    shots.take_outside(start, preset.name, tr("from outside, {}, walls left out", preset.meaning), options);
  }
  ViewOptions options = view_of(pictures::choice_of(pictures::kCameraPresets[0]), around);
  options.walls = options.instruments = false;
  shots.take_outside(start, "organs", "the organs alone", options);
}

struct Wanted {
  std::string folder, scene, only, size = "800x600";
};

void add_scene(Json& list, const std::string& name, const Wanted& wanted) {
  const pictures::PictureSize size = pictures::parse_size(wanted.size);
  const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson(name);
  const sim::Model& model = lesson->model;
  pictures::Pictures pictures(model, size);
  pictures::Shots shots(pictures, std::filesystem::path(wanted.folder) / name, wanted.only);
  const sim::State start = sim::initial_state(model);
  shots.take(start, "endoscope", "through the endoscope, as placed");
  organs(model, start, shots);
  tubes(model, start, shots);
  instruments(model, start, shots);
  exchange(model, start, shots);
  heights(model, start, shots);
  clips_and_cut(model, start, shots);
  bites(model, start, shots);
  burn(model, start, shots);
  bleed(model, start, shots);
  analysis(model, start, shots);
  styles(start, pictures, shots);
  eyes(model, start, size, shots);
  outside(model, start, shots);
  shots.write_index();
  for (const std::string& file : shots.files()) list.push_back(file);
}

int gallery(const Wanted& wanted, bool json) {
  const std::vector<scene::SceneEntry> all = scene::list_scenes(attempt::scenes_folder());
  const std::string& scene = wanted.scene;
  if (!scene.empty() && std::none_of(all.begin(), all.end(), [&](const auto& s) { return s.name == scene; }))
    throw core::BadInput({{{"--scene", 0, 0}, tr("expected a scene (see trocar list), got '{}'", scene)}});
  if (!wanted.only.empty()) {
    std::vector<scene::Description> wanted_scenes;
    for (const scene::SceneEntry& s : all)
      if (scene.empty() || s.name == scene) wanted_scenes.push_back(scene::read_scene(s.path));
    check_picture_name(wanted.only, wanted_scenes);
  }
  attempt::make_folder(wanted.folder);
  Json files = Json::array();
  for (const scene::SceneEntry& s : all)
    if (scene.empty() || s.name == scene) add_scene(files, s.name, wanted);
  if (files.empty())
    throw core::BadInput({{{"--only", 0, 0}, tr("expected a picture of these scenes, none is '{}'", wanted.only)}});
  if (json)
    print({{"pictures", files}});
  else
    for (const Json& f : files) fmt::print("{}\n", f.get<std::string>());
  return core::kDone;
}

}  // namespace

void add_gallery(CLI::App& program, Chosen& chosen) {
  auto o = std::make_shared<Wanted>();
  CLI::App* c = add_command(program, chosen, "gallery", tr("Write pictures of every scene to a folder"),
                            "trocar gallery pictures --scene gynaecology --size 1024x768");
  c->add_option("folder", o->folder, tr("folder for the pictures"))->required();
  c->add_option("--scene", o->scene, tr("only this scene; default: all"));
  c->add_option("--only", o->only, tr("only pictures whose name contains this"));
  c->add_option("--size", o->size, tr("WIDTHxHEIGHT of pictures"))->capture_default_str();
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return gallery(*o, chosen.json); }; });
}

}  // namespace trocar::app
