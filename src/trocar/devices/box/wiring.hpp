// Which channel of a box is which axis of which hand, with its calibration from codes to radians, metres or 0 .. 1, and
// which digital bit is which pedal. Read from a file by attempt/box/box_file.hpp; default_wiring() is what the software
// box has.
//
// A potentiometer of 0.5 % linearity over 120 degrees is wrong by 0.6 degrees, 2.1 mm at the tip 200 mm away, so that
// every axis has a table of its own.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <trocar/devices/box/block.hpp>

namespace trocar::devices {

/// Piecewise linear and monotone (unfit() says how steep and flat it may be); beyond its ends the first and the last
/// piece continue.
struct AxisTable {
  std::vector<double> codes;   ///< rising, at least two
  std::vector<double> values;  ///< strictly rising or strictly falling: [rad], [m] or 0 .. 1

  double value(double code) const noexcept;
  double code(double value) const noexcept;  ///< the inverse, exact at the knots
};

/// Empty, or what keeps `table` from being one.
std::string unfit(const AxisTable& table);

/// The controlled ones: two hands by side, as the picture shows their trocars, two more in the scene's order, and the
/// endoscope.
enum class BoxActor { left, right, third, fourth, scope };
inline constexpr int kBoxActors = 5, kBoxHands = 4;
/// The last one is a hand's handle (0 open .. 1 closed) and the endoscope's light post [rad].
enum class BoxAxis { yaw, pitch, roll, depth, handle };
inline constexpr int kBoxAxes = 5;

inline constexpr std::array<const char*, kBoxActors> kBoxActorNames = {"left", "right", "third", "fourth", "scope"};
inline constexpr std::array<const char*, kBoxAxes> kBoxAxisNames = {"yaw", "pitch", "roll", "depth", "handle"};

struct WiredAxis {
  int channel = -1;  ///< -1: there is none
  AxisTable table;
};

/// Foot switches, and what sits on handles: bits of BoxPose::pedals.
enum BoxPedal : std::uint32_t {
  kBoxCoagulate = 1,
  kBoxCut = 2,
  kBoxWipe = 4,
  kBoxDeclare = 8,
  kBoxReset = 16,
};
inline constexpr int kBoxPedals = 5;
inline constexpr std::array<const char*, kBoxPedals> kBoxPedalNames = {"coagulate", "cut", "wipe", "declare", "reset"};
/// Of each hand.
enum class BoxButton { next_instrument, irrigate, suck };
inline constexpr int kBoxButtons = 3;
inline constexpr std::array<const char*, kBoxButtons> kBoxButtonNames = {"next_instrument", "irrigate", "suck"};

/// The low-pass of every axis: the one-euro filter [Casiez 2012, CHI]. Its corner lies at `rest` for what stands still
/// and rises with speed, so that noise is taken where it is seen and lag where it is not felt:
/// corner = rest + per_speed * |speed| [Hz]; lag = 1 / (2 pi corner).
struct BoxFilter {
  double rest = 5;                                                 ///< [Hz]; 0: no filter
  std::array<double, kBoxAxes> per_speed = {40, 40, 20, 400, 20};  ///< [Hz] for each rad/s, m/s, 1/s
};

struct BoxWiring {
  int baud = 38'400;
  double rate = 50;  ///< blocks a second
  bool raw = false;
  /// True: angles of yaw, pitch, roll and post count from where a scene places the instrument, so that the middle of
  /// the box's reach is the middle of the scene's work. False: from upright, as in scenes.
  bool from_placed = true;
  BoxFilter filter;
  std::array<std::array<WiredAxis, kBoxAxes>, kBoxActors> axes;
  std::array<int, kBoxPedals> pedals;                           ///< bit of each; -1: none
  std::array<std::array<int, kBoxButtons>, kBoxHands> buttons;  ///< bit of each; -1: none
  std::uint32_t inverted = 0;                                   ///< bits that are 0 while closed

  BoxWiring();
  const WiredAxis& axis(BoxActor actor, BoxAxis axis) const { return axes[std::size_t(actor)][std::size_t(axis)]; }
  bool has(BoxActor actor) const;  ///< any axis of it
  ChannelMask mask() const;        ///< all channels that are wired
};

/// 25 channels in order (left, right, third, fourth hand, endoscope; yaw, pitch, roll, depth, handle or post), each
/// with 80 % of its codes in use: yaw and pitch +-60 degrees (0.037 degrees a code, 0.13 mm at 200 mm; the endoscope
/// +-85, as it looks at trocars beside it), roll and post +-180, depth 0 to 300 mm, handle 0 to 1. Bits 0 to 4: the
/// pedals; from 8 on three for each hand.
const BoxWiring& default_wiring();

}  // namespace trocar::devices
