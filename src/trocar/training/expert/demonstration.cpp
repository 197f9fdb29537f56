#include <fmt/format.h>

#include <trocar/training/expert/demonstration.hpp>
#include <trocar/training/expert/plan_reader.hpp>

namespace trocar::training {
namespace {

bool asks_for_steps(const scene::JsonValue& v) {
  for (const scene::JsonValue& item : v.items)
    if (asks_for_steps(item)) return true;
  for (const scene::JsonMember& m : v.members)
    if (m.key == "step" || asks_for_steps(m.value)) return true;
  return false;
}

/// With what the file's part is read: its names in this scene must outlive the reading.
struct Source {
  Source(const Exercise& exercise, const sim::Model* model, std::uint64_t seed, Faults& all_faults)
      : names(exercise.names(model, seed, all_faults)), faults(all_faults) {
    reading.named = &names;
    reading.model = model;
    reading.file = &exercise.demonstration.file;
    reading.faults = &faults;
  }
  Names names;
  Faults& faults;
  RuleReading reading;
};

}  // namespace

Demonstration read_demonstration(const Exercise& exercise, const sim::Model& model, std::uint64_t seed) {
  Faults faults;
  if (exercise.demonstration.value.kind == scene::JsonValue::Kind::null)
    throw core::BadInput({{{exercise.file.string(), 0, 0},
                           "expected the key \"demonstration\", got none: this exercise has no demonstration"}});
  Demonstration made;
  made.watches = std::make_unique<FactWatches>();
  if (asks_for_steps(exercise.demonstration.value))
    made.judge = std::make_unique<Monitor>(exercise, model, Mode::assessed, seed);
  Source source(exercise, &model, seed, faults);
  source.reading.facts = made.watches.get();
  source.reading.steps = made.judge ? &made.judge->board().steps() : nullptr;
  made.plan = read_plan(exercise.demonstration.value, source.reading);
  if (const RecordedChoices* recorded = exercise.recorded_choices_for(seed)) made.choices = recorded->choices;
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  return made;
}

void check_demonstration(const Exercise& exercise, const sim::Model* model, Faults& faults, std::uint64_t seed) {
  if (exercise.demonstration.value.kind == scene::JsonValue::Kind::null) return;
  FactWatches watches;
  std::unique_ptr<Monitor> judge;
  if (model && asks_for_steps(exercise.demonstration.value)) try {
      judge = std::make_unique<Monitor>(exercise, *model, Mode::assessed, seed);
    } catch (const core::BadInput&) {
      return;  // the rules' own faults come first
    }
  Faults of_names;  // reported already when the exercise was read
  Source source(exercise, model, seed, of_names);
  source.reading.faults = &faults;
  source.reading.facts = model ? &watches : nullptr;
  source.reading.steps = judge ? &judge->board().steps() : nullptr;
  read_plan(exercise.demonstration.value, source.reading);
}

}  // namespace trocar::training
