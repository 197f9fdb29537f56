#include <trocar/training/expert/bleeding_surgeon.hpp>
#include <trocar/training/expert/surgeon.hpp>

namespace trocar::training {

std::unique_ptr<Expert> make_expert(const Exercise& exercise, const sim::Model& model, const Manner& manner) {
  if (exercise.kind == Exercise::Kind::bleeding_control)
    return std::make_unique<BleedingSurgeon>(exercise, model, manner);
  return std::make_unique<Surgeon>(exercise, model, manner);
}

}  // namespace trocar::training
