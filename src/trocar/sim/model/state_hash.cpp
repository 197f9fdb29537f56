#include <trocar/core/field_difference.hpp>
#include <trocar/core/field_hash.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::sim {

std::uint64_t hash_of(const State& s) noexcept {
  core::Hasher h;
  core::add_fields(h, s);
  return h.value();
}

std::string first_difference(const State& a, const State& b) { return core::first_difference(a, b); }

}  // namespace trocar::sim
