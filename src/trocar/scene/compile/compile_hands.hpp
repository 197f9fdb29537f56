// Hands at trocars: which instruments go through each, where hands and endoscope begin.
#pragma once

#include <vector>

#include <trocar/scene/description/description.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::scene {

/// Fills Model::hands, scope and start. Every instrument of the scene that fits a hand's trocar is in its rack, the
/// placed one first.
void compile_hands(const Description& description, sim::Model& model, std::vector<core::Fault>& faults);

/// Does some hand of the scene have an injection needle to choose?
bool has_needle(const sim::Model& model);

/// What needles have to do with organs: forces at which skins give way, and what takes fluid up.
/// Nothing in scenes without a needle. After hands and organs.
void compile_injection(const Description& description, sim::Model& model);

/// Is there a loop among them?
bool has_slings(const std::vector<SutureSetting>& settings);
/// Sutures, once all bodies and hands are known: what a stitch meets in each, who holds what, how the thread lies.
void compile_sutures(const Description& d, sim::Model& model, std::vector<core::Fault>& faults);

}  // namespace trocar::scene
