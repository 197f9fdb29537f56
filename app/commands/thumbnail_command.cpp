// trocar thumbnail: the picture of an exercise for the start screen, which runs this in the background. Not in the
// program's help.
#include <sys/resource.h>

#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/pictures/pictures.hpp>

#include "commands/command.hpp"
#include "start/thumbnails.hpp"

namespace trocar::app {
namespace {

int make_thumbnail(const std::string& exercise, const std::filesystem::path& file) {
  setpriority(PRIO_PROCESS, 0, 19);  // whoever practises meanwhile comes first
  const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson(exercise);
  pictures::Pictures pictures(lesson->model, {kThumbnailWidth, kThumbnailHeight});
  view::ViewOptions options;
  options.eye_index = 1;
  const render::Image image = pictures.still(sim::initial_state(lesson->model), options);
  attempt::make_folder(file.parent_path());
  std::filesystem::path fresh = file;
  fresh += ".new.png";
  render::write_png(fresh.string(), image);
  std::filesystem::rename(fresh, file);
  return core::kDone;
}

}  // namespace

void add_thumbnail(CLI::App& program, Chosen& chosen) {
  struct Given {
    std::string exercise, file;
  };
  auto given = std::make_shared<Given>();
  CLI::App* c = add_command(program, chosen, "thumbnail", "Write the picture of an exercise",
                            "trocar thumbnail basics/camera-0 camera.png");
  c->group("");
  c->add_option("exercise", given->exercise, "a name that `trocar list` shows")->required();
  c->add_option("file", given->file, "of the picture")->required();
  c->callback([given, &chosen] { chosen.run = [given] { return make_thumbnail(given->exercise, given->file); }; });
}

}  // namespace trocar::app
