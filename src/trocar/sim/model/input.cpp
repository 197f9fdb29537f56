#include <trocar/sim/model/input.hpp>

namespace trocar::sim {

void add_to_hash(core::Hasher& hasher, const Input& input) noexcept {
  hasher.add_bytes(&input, kInputWithoutWrists);
  if (input.bends()) hasher.add_bytes(input.wrists, sizeof input.wrists);
}

}  // namespace trocar::sim
