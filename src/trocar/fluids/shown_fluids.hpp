// Fluids as a picture shows them, in few bytes: enough to draw them, not to continue with them. What lies on the lens;
// drops, film and pool in whole nanolitres; smoke in shades. No speeds in the pool, and no account.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/fluids/fluids.hpp>

namespace trocar::fluids {

/// Appends what is to be seen.
void put_shown(const FluidsModel& model, const FluidsState& state, std::vector<std::uint8_t>& out);

/// @param state  shows that and nothing else; undefined where this fails
/// @return bytes read; -1 where they are no fluids, or more than the model has room for
std::ptrdiff_t take_shown(const FluidsModel& model, std::span<const std::uint8_t> bytes, FluidsState& state);

/// Dry, in clear air and with a clean lens.
void show_none(FluidsState& state);

}  // namespace trocar::fluids
