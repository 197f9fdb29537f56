// The kinds of instruments: what files call them, and what each can do. Code that handles instruments asks what one
// can do and not which kind it is:
//
//   if (tool.can().set_clips) ...
//
// A new kind is a line in both lists here, and its drawing (view/instruments/kind_shapes.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>

namespace trocar::interactions {

/// Their numbers stand in recordings: a new one comes last.
enum class ToolKind : std::int32_t {
  grasper,
  clip_applier,
  scissors,
  probe,
  suction_irrigator,
  hook,
  bipolar,
  dissector,
  bag,
  injection_needle,
  endoloop,
};

/// Verbs that instruments do with what is at their tip. What jaws do is in sim/verbs.
struct Abilities {
  bool grip = false;       ///< jaws that close on tissue hold it
  bool set_clips = false;  ///< jaws that close put a clip around what is between them
  bool cut = false;        ///< jaws are blades
  bool irrigate = false;   ///< the end is a bore with two valves, for water and suction
  bool coagulate = false;  ///< an electrode is at the tip ...
  bool bipolar = false;    ///< ... and current goes from jaw to jaw
  bool hook = false;       ///< its end is a wire that may be bent to a foot, which catches bands
  bool spread = false;     ///< jaws that open push apart what lies on their outer sides
  bool inject = false;     ///< a hollow needle comes out of the shaft, with a syringe behind it
  bool bag = false;        ///< a sleeve that the scene's bag comes out of (interactions/objects/bag.hpp)
  bool sling = false;      ///< a tube with a loop of thread at its mouth (interactions/objects/suture_sling.hpp)

  /// Legs of clips and blades come astride of what they close on.
  constexpr bool blunt() const noexcept { return !set_clips && !cut; }
};

struct KindOfTool {
  ToolKind kind;
  const char* name;  ///< in files
  Abilities can;
};
inline constexpr KindOfTool kToolKinds[] = {
    {ToolKind::grasper, "grasper", {.grip = true}},
    {ToolKind::clip_applier, "clip_applier", {.set_clips = true}},
    {ToolKind::scissors, "scissors", {.cut = true}},
    {ToolKind::probe, "probe", {}},
    {ToolKind::suction_irrigator, "suction_irrigator", {.irrigate = true}},
    {ToolKind::hook, "hook", {.coagulate = true, .hook = true}},
    {ToolKind::bipolar, "bipolar", {.grip = true, .coagulate = true, .bipolar = true}},
    {ToolKind::dissector, "dissector", {.grip = true, .spread = true}},
    {ToolKind::bag, "bag", {.bag = true}},
    {ToolKind::injection_needle, "injection_needle", {.inject = true}},
    {ToolKind::endoloop, "endoloop", {.sling = true}},
};

constexpr const KindOfTool& about(ToolKind kind) noexcept { return kToolKinds[std::size_t(kind)]; }

constexpr bool kinds_stand_at_their_numbers() noexcept {
  for (std::size_t i = 0; i < std::size(kToolKinds); ++i)
    if (std::size_t(kToolKinds[i].kind) != i) return false;
  return true;
}
static_assert(kinds_stand_at_their_numbers());

/// For messages: "hook or bipolar".
std::string kinds_that(bool Abilities::*can);

}  // namespace trocar::interactions
