// What is controlled when an attempt begins: there is always something. The endoscope where a scene has no hand or the
// first step is about the picture; else the hand that the first step needs; else one that the picture shows.
#pragma once

#include <trocar/attempt/session.hpp>

namespace trocar::attempt {

/// A hand's number, or devices::kScope. Before the attempt runs.
int first_control(const Session& session);

/// Does the endoscope point at this hand's tip? What lies between is not looked for.
bool tip_in_picture(const sim::Model& model, const sim::State& state, int hand);

}  // namespace trocar::attempt
