// Blood that has left vessels, by the fluids' ledger.
#pragma once

#include <trocar/sim/model/state.hpp>

namespace trocar::training {

/// What lay there when the scene began was lost before [m^3].
inline double blood_lost(const sim::Model& model, const sim::State& state) {
  const std::int64_t bled = state.fluids.ledger.in[size_t(fluids::Source::kBled)].blood;
  return fluids::kM3PerPicolitre * double(bled - model.wet.pool_at_start.blood);
}

}  // namespace trocar::training
