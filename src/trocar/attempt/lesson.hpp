// An exercise ready to be done: its scene compiled, who watches it, who can demonstrate it. A bare scene is a lesson
// without a goal: free practice.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <trocar/core/json.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/training/exercise/monitor.hpp>

namespace trocar::attempt {

/// What the device behind a source says of itself, for who shows it.
struct DeviceNews {
  std::string text;            ///< "box: 50 blocks a second, 0.0 % lost"
  std::string warning, hint;   ///< for the trainee; empty: none
  std::int64_t acquired = 0;   ///< when what leads now was measured, on the steady clock [ns]; 0: not known
  bool wants_restart = false;  ///< who leads wants the exercise from its beginning
};

/// The source of inputs when no person has control: a file, a recording, the demonstration. One per attempt.
class InputSource {
 public:
  virtual ~InputSource() = default;
  /// The input of the next tick, from the State as it stands; false: there is no more, the attempt ends.
  virtual bool next(const sim::State& state, sim::Input& input) = 0;
  /// False: there will be a next input, but not now: a device or somebody of the team is away, see waits_for(). Time
  /// stands still meanwhile.
  virtual bool ready() { return true; }
  /// Why, for people; empty: it is ready. Any thread.
  virtual std::string waits_for() const { return {}; }
  /// Ticks that are there already and wait to be made: who is behind hurries.
  virtual std::uint64_t behind() const { return 0; }
  /// What the tick made of it.
  virtual void after(const sim::State&, const sim::StepReport&) {}
  /// From any thread. Nothing: no device is behind it.
  virtual std::optional<DeviceNews> device() const { return std::nullopt; }
  /// What there is to say about it in the result.
  virtual Json describe() const { return Json::object(); }
};

struct Lesson {
  std::string name;  ///< "SCENE/EXERCISE", or the path as given
  std::string title;
  std::filesystem::path file, scene;
  std::uint64_t seed = 0;  ///< of the anatomy; 0: the standard patient
  sim::Model model;
  std::optional<training::Exercise> exercise;  ///< nothing for a bare scene

  std::unique_ptr<training::Monitor> monitor(bool scored = true) const;  ///< null for a bare scene
  std::unique_ptr<InputSource> surgeon() const;  ///< @throws core::BadInput where nobody knows how
};

/// Exercise files name a scene; scene files do not. False also for what cannot be read.
bool is_exercise(const std::filesystem::path& path);
bool is_exercise(const scene::JsonValue& root);

/// Reads and compiles what EXERCISE names; reports on stderr when that takes a while.
/// @param seed varies the anatomy within its healthy range; 0: the standard patient. A recording's header holds it.
/// @throws core::BadInput, core::EnvironmentLacks
std::unique_ptr<Lesson> load_lesson(const std::string& exercise, std::uint64_t seed = 0);

/// Changes a scene before it is compiled; may throw core::BadInput.
using Adapt = std::function<void(scene::Description&)>;
/// The same of a scene that `adapt` has changed, after its anatomy was varied.
/// @param report  what the compiler said; where its said() is empty, what takes long is reported on stderr
std::unique_ptr<Lesson> load_adapted(const std::string& exercise, std::uint64_t seed, const Adapt& adapt,
                                     scene::CompileReport* report = nullptr);

}  // namespace trocar::attempt
