#include <trocar/core/field_hash.hpp>
#include <trocar/fluids/ledger.hpp>

namespace trocar::fluids {

Mix imbalance(const Ledger& ledger) noexcept {
  Mix sum;
  for (const Mix& m : ledger.in) sum += m;
  for (const Mix& m : ledger.at) sum -= m;
  return sum;
}

bool balanced(const Ledger& ledger) noexcept {
  for (const Mix& m : ledger.at)
    if (m.blood < 0 || m.saline < 0 || m.bile < 0) return false;
  return imbalance(ledger).empty();
}

void add_to_hash(core::Hasher& hasher, const Ledger& ledger) noexcept { core::add_fields(hasher, ledger); }

}  // namespace trocar::fluids
