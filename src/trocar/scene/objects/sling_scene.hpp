// A suture that is a sling: a loop that an instrument of the kind "endoloop" brings in
// (interactions/objects/suture_sling.hpp).
#pragma once

#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::sim {
struct Model;
}
namespace trocar::interactions {
struct SutureModel;
}

namespace trocar::scene {

struct SlingSetting {
  bool there = false;
  double loop = 0.060;            ///< diameter of the open loop [m]
  double slides = 1, slips = 11;  ///< of its knot [N]
  /// Thread that is computed: all of the open loop.
  double thread() const noexcept;
};

struct SutureSetting;

Key sling_key();
/// What it says is checked against the suture that it is of.
SlingSetting read_sling(const JsonObject& suture, const SutureSetting& s);
/// Once its thread has been built.
void compile_sling(const SlingSetting& s, std::int32_t first_hold, interactions::SutureModel& m);
/// Every sling needs a hand that can bring it in.
void expect_endoloop(const std::vector<SutureSetting>& settings, const sim::Model& model,
                     std::vector<core::Fault>& faults);

}  // namespace trocar::scene
