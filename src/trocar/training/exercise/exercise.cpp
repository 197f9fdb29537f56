#include <trocar/training/exercise/exercise.hpp>

namespace trocar::training {

const Penalty* Exercise::penalty(const std::string& code) const {
  for (const Penalty& p : penalties)
    if (p.code == code) return &p;
  return nullptr;
}

const StepText* Exercise::step(const std::string& step_name) const {
  for (const StepText& s : steps)
    if (s.name == step_name) return &s;
  return nullptr;
}

const RecordedChoices* Exercise::recorded_choices_for(std::uint64_t seed) const {
  for (const RecordedChoices& r : recorded_choices)
    if (r.seed == seed) return &r;
  return nullptr;
}

double Exercise::limit(const std::string& limit_name, double otherwise) const {
  const Limit* l = find_limit(limits, limit_name);
  return l && !l->is_range ? l->si() : otherwise;
}

Names Exercise::names(const sim::Model* model, std::uint64_t seed, Faults& faults) const {
  Sets made;
  for (const auto& [set_name, part] : sets)
    made.push_back(read_set(set_name, part.value, part.file, model, seed, faults));
  return {model ? limits_in(limits, model->anatomy) : limits, std::move(made)};
}

}  // namespace trocar::training
