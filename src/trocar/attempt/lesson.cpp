#include <chrono>

#include <fmt/format.h>

#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/attempt/progress.hpp>
#include <trocar/attempt/sources.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/description/vary.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/json/json.hpp>

namespace trocar::attempt {

std::unique_ptr<training::Monitor> Lesson::monitor(bool scored) const {
  const training::Mode mode = scored ? training::Mode::assessed : training::Mode::familiarisation;
  return exercise ? std::make_unique<training::Monitor>(*exercise, model, mode, seed) : nullptr;
}

std::unique_ptr<InputSource> Lesson::surgeon() const {
  if (!exercise)
    throw core::BadInput(
        {{{name, 0, 0}, "expected an exercise with a demonstration, got a scene without an exercise"}});
  return std::make_unique<SurgeonSource>(*exercise, model, seed);
}

bool is_exercise(const std::filesystem::path& path) {
  std::vector<core::Fault> faults;
  return is_exercise(scene::load_json(path, faults).root);
}

bool is_exercise(const scene::JsonValue& root) {
  const scene::JsonMember* scene = root.find("scene");
  return scene && scene->value.kind == scene::JsonValue::Kind::string;
}

std::unique_ptr<Lesson> load_lesson(const std::string& exercise, std::uint64_t seed) {
  return load_adapted(exercise, seed, {});
}

std::unique_ptr<Lesson> load_adapted(const std::string& exercise, std::uint64_t seed, const Adapt& adapt,
                                     scene::CompileReport* given) {
  const auto started = std::chrono::steady_clock::now();
  auto lesson = std::make_unique<Lesson>();
  lesson->name = exercise;
  lesson->file = lesson->scene = find_exercise(exercise, scenes_folder());
  training::Faults faults;  // of the exercise: told together with what the scene lacks for it
  if (is_exercise(lesson->file)) {
    lesson->exercise = training::read_exercise(lesson->file, faults);
    lesson->scene = lesson->exercise->scene;
    lesson->title = lesson->exercise->title;
    if (!std::filesystem::is_regular_file(lesson->scene) && !faults.empty()) throw core::BadInput(std::move(faults));
  }
  scene::Description description = scene::read_scene(lesson->scene);
  if (!lesson->exercise) lesson->title = description.title;
  lesson->seed = seed;
  scene::vary(description, seed);
  if (adapt) adapt(description);
  core::log::info("compiling {}", lesson->scene.string());
  scene::CompileReport own;
  scene::CompileReport& report = given ? *given : own;
  if (!report.said) report.said = told_of_solvers();
  lesson->model = scene::compile(description, &report);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - started;
  // An exercise that does not fit its scene is reported here, not when somebody starts it.
  if (lesson->exercise) training::check_in_scene(*lesson->exercise, lesson->model, faults);
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  core::log::info("compiled in {:.1f} s: {} free nodes", took.count(), lesson->model.free_nodes());
  for (const core::Fault& warning : report.warnings) core::log::warn("{}", core::to_string(warning));
  return lesson;
}

}  // namespace trocar::attempt
