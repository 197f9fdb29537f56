// trocar gallery: the picture book. In this first form: every scene through its endoscope and from outside.
#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/scene/reader.hpp>

#include "command.hpp"
#include "json.hpp"
#include "lesson.hpp"
#include "paths.hpp"
#include "pictures.hpp"

namespace trocar::app {
namespace {

void add_scene(Json& list, const std::string& name, const std::filesystem::path& folder, PictureSize size) {
  const std::unique_ptr<Lesson> lesson = load_lesson(name);
  Pictures pictures(lesson->model, size);
  Shots shots(pictures, folder / name);
  const sim::State state = sim::initial_state(lesson->model);
  shots.take(state, "endoscope", "through the endoscope, as placed");
  view::ViewOptions outside;
  outside.camera = view::ViewOptions::Camera::outside;
  outside.walls = false;
  shots.take_outside(state, "outside", "from outside, walls left out", outside);
  outside.instruments = false;
  shots.take_outside(state, "organs", "the organs alone", outside);
  shots.write_index();
  for (const std::string& file : shots.files()) list.push_back(file);
}

int gallery(const std::string& folder, const PictureSize size, bool json) {
  make_folder(folder);
  Json files = Json::array();
  for (const scene::SceneEntry& s : scene::list_scenes(scenes_folder())) add_scene(files, s.name, folder, size);
  if (json)
    print({{"pictures", files}});
  else
    for (const Json& f : files) fmt::print("{}\n", f.get<std::string>());
  return core::kDone;
}

}  // namespace

void add_gallery(CLI::App& program, Chosen& chosen) {
  struct Options {
    std::string folder, size = "800x600";
  };
  auto o = std::make_shared<Options>();
  CLI::App* c = add_command(program, chosen, "gallery", "Write pictures of every scene to a folder",
                            "trocar gallery pictures --size 1024x768");
  c->add_option("folder", o->folder, "where the pictures go")->required();
  c->add_option("--size", o->size, "of pictures")->capture_default_str();
  c->callback(
      [o, &chosen] { chosen.run = [o, &chosen] { return gallery(o->folder, parse_size(o->size), chosen.json); }; });
}

}  // namespace trocar::app
