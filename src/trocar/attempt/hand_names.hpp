// The hands and what they hold, in words for people.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <trocar/sim/model/state.hpp>

namespace trocar::attempt {

/// "clip_applier" -> "clip applier"
std::string in_words(std::string name);

int hand_count(const sim::Model& model);
/// Where hand `h` comes in: "left lateral".
std::string hand_name(const sim::Model& model, int h);
/// Of the first two hands the left one and the right one: the left one's trocar lies further to the left for who looks
/// from the endoscope's trocar at the instruments, upright; the first picture may look elsewhere, even the other way.
/// {0, 1} where there are not two.
std::array<int, 2> sides_of(const sim::Model& model);
/// The instrument that hand `h` holds now.
const interactions::ToolModel& held_by(const sim::Model& model, const sim::State& state, int h);

/// Does it hold a suction-irrigator, or a needle, whose plunger is controlled as those valves are?
bool has_valves(const sim::Model& model, const sim::State& state, int h);
/// An electrode without jaws.
bool is_bare_electrode(const sim::Model& model, const sim::State& state, int h);
/// What flows through that hand's suction-irrigator: "water, suction: gas", or empty.
std::string flow_in_words(const sim::State& state, int h);
/// The account of the fluids in mL, a line each: bled, irrigated; where they are, which adds up to these. None in
/// scenes without.
std::vector<std::string> fluid_account(const sim::Model& model, const sim::State& state);
/// The patient's pulse and pressures as they fall with the loss of blood, and by how much the arteries' pulse is shown
/// and felt larger than it is, a line each. None in scenes without vessels.
std::vector<std::string> patient_in_words(const sim::Model& model, const sim::State& state);
/// What lies on the endoscope's lens: "lens fogged, 40 %", "lens is being wiped, 5 s"; empty where it is clear.
std::string lens_in_words(const sim::Model& model, const sim::State& state);

/// An instrument that fits a hand's trocar.
struct Choosable {
  int index = -1;  ///< as ToolInput::instrument
  std::string name;
  bool held = false;
};
std::vector<Choosable> choosable(const sim::Model& model, const sim::State& state, int h);

/// The pull of the tissue on hand `h` [N].
double pull_on(const sim::State& state, int h);
/// What the abdominal wall bears at the hand's trocar in this tick [N].
double push_at_trocar(const sim::Model& model, const sim::State& state, int h);

}  // namespace trocar::attempt
