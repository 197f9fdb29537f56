#include <trocar/training/expert/performer.hpp>

namespace trocar::training {

std::unique_ptr<Expert> make_expert(const Exercise& exercise, const sim::Model& model, const Manner& manner,
                                    std::uint64_t seed) {
  return std::make_unique<Performer>(model, read_demonstration(exercise, model, seed), manner);
}

}  // namespace trocar::training
