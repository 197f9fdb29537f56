#include <algorithm>

#include <trocar/fluids/insufflator.hpp>

namespace trocar::fluids {

CavityGas full(const Insufflator& i) noexcept { return {.pressure = i.set, .flow = 0}; }

void advance(const Insufflator& i, double sucked, double dt, CavityGas& gas) noexcept {
  gas.flow = i.flow * std::clamp((i.set - gas.pressure) / i.band, 0.0, 1.0);
  gas.pressure = std::max(gas.pressure + dt / i.compliance * (gas.flow - sucked), 0.0);  // then air follows
}

}  // namespace trocar::fluids
