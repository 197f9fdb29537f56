// Stages: contacts.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Instruments on tissue: contact and hold.
void resolve_instrument_contacts(StepContext& context) noexcept;
/// Organs on organs.
void resolve_body_contacts(StepContext& context) noexcept;

}  // namespace trocar::sim
