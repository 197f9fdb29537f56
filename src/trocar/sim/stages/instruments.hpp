// Instruments that meet push each other aside.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// After the hands have moved: rods that overlap separate by turning about their trocars. Who is met farther from the
/// trocar turns more easily and takes more of the way, by the square of that distance. They were apart when the tick
/// began, so what side each is on needs no memory. The endoscope neither pushes nor is pushed.
void separate_instruments(StepContext& context) noexcept;

/// What each hand feels of that, among its contacts: 250 N/m of how far both hands want to be through each other, at
/// most 15 N. Two hands of 500 N/m (interactions/instrument/wall_stop.hpp) in a row.
void feel_instruments(StepContext& context) noexcept;

}  // namespace trocar::sim
