// What the hands do in one tick: the whole input of the simulation, and the content of a recording's input log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/kinematics/fulcrum.hpp>

namespace trocar::sim {

inline constexpr int kMaxTools = 4;  ///< hands at trocars
inline constexpr int kMaxRack = 8;   ///< instruments that one hand may choose from

/// What one hand at its trocar wants: which instrument of its rack (HandModel::rack) and where. Angles [rad], depth
/// port-to-tip [m], handle 0 open .. 1 closed.
struct ToolInput {
  float yaw = 0, pitch = 0, roll = 0, depth = 0, handle = 0;
  std::int32_t instrument = 0;  ///< 0: the one that it began with

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("yaw", s.yaw), v("pitch", s.pitch), v("roll", s.roll), v("depth", s.depth), v("handle", s.handle),
        v("instrument", s.instrument);
  }
};

/// The endoscope: `roll` turns the camera head (the picture), `post` the light post (an oblique view's direction).
struct ScopeInput {
  float yaw = 0, pitch = 0, roll = 0, depth = 0, post = 0;

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("yaw", s.yaw), v("pitch", s.pitch), v("roll", s.roll), v("depth", s.depth), v("post", s.post);
  }
};

/// Bits of Input::pedals: foot switches, and valves on the handles of suction-irrigators.
enum Pedal : std::uint32_t {
  kBlue = 1,     ///< coagulation
  kYellow = 2,   ///< cutting current
  kWipe = 4,     ///< the endoscope is taken out and wiped
  kDeclare = 8,  ///< "this is what was to be shown", said aloud: once for as long as it is held
};
/// Keys of the generator's panel (tissue::PanelKey), from this bit on.
inline constexpr int kPanelBit = 16;
constexpr std::uint32_t irrigates(int hand) { return 1u << (8 + 2 * hand); }
constexpr std::uint32_t sucks(int hand) { return 2u << (8 + 2 * hand); }

/// How a hand bends an instrument that bends: up (about the direction in which jaws open) and aside [rad]. Joints of a
/// wrist; of a redundant instrument how its tip is turned.
struct WristInput {
  float pitch = 0, yaw = 0;

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("pitch", s.pitch), v("yaw", s.yaw);
  }
};

struct Input {
  ScopeInput scope;
  ToolInput tools[kMaxTools];
  std::uint32_t pedals = 0;  ///< Pedal, irrigates(), sucks(), keys of the panel
  /// Last, so that what recordings without them hold reads as it did, and hashed only where there are any.
  WristInput wrists[kMaxTools];

  bool bends() const noexcept {
    for (const WristInput& w : wrists)
      if (w.pitch != 0 || w.yaw != 0) return true;
    return false;
  }

  static constexpr bool kAsBytes = true, kOwnHash = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("scope", s.scope), v("tools", s.tools), v("pedals", s.pedals), v("wrists", s.wrists);
  }
};
inline constexpr std::size_t kInputWithoutWrists = 20 + kMaxTools * 24 + 4;
static_assert(std::is_trivially_copyable_v<Input> && sizeof(Input) == kInputWithoutWrists + kMaxTools * 8,
              "no padding");
/// In one piece; wrists only where one is bent.
void add_to_hash(core::Hasher& hasher, const Input& input) noexcept;

inline kinematics::FulcrumPose pose_of(const ToolInput& t) { return {t.yaw, t.pitch, t.roll, t.depth}; }
inline kinematics::FulcrumPose pose_of(const ScopeInput& s) { return {s.yaw, s.pitch, s.roll, s.depth}; }
inline ToolInput tool_input(const kinematics::FulcrumPose& p, float handle, std::int32_t instrument = 0) {
  return {float(p.yaw), float(p.pitch), float(p.roll), float(p.depth), handle, instrument};
}

}  // namespace trocar::sim
