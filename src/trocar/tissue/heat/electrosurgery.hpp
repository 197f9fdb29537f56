// High-frequency current from a generator through an electrode into tissue: panel and foot switch, how much of the set
// power arrives at an impedance that rises as tissue dries, the electrode's own heat, and its sticking to char.
//
//   load       Z = back + wet 1 mm / (radius g pressed): constriction resistance of a contact, g the tissue's
//              conductance beside wet one (HeatContact); back: the way through the body, none between bipolar jaws
//   generator  P = set Z / low below `low` (current's limit), set between, set high / Z above (voltage's limit)
//   tissue     eta P (1 + g) / 2: what sparks over dry tissue heats gas
//   electrode  c dT/dt = share P + G (T_tissue - T) - G_air (T - 37); what it gives tissue is a source of heat like any
//   sticking   grows with a time of 0.3 s while the tissue at the contact is above 150 C, fully at 200 C, until torn
//   off
// A mode says how far current is focussed. The figures are our choice within what generators' manuals show of power
// over load and [Munro 2012] says of wave forms; docs/science/heat.md holds them against measurements.
//
// An electrode works once in a step of the heat (8 ticks), for all of them.
//
//   ElectrodeDescription hook;  ElectrodeState e;  GeneratorPanel panel;
//   Discharge d = energise(hook, panel, {.blue = true}, {.body = 3, .a = tip, .b = tip}, heat_model, shape, heat, work,
//   e); advance(heat_model, d.span(), shape, heat, work);      // heat.hpp; its `boiled` is what smokes
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/numerics/vec3.hpp>
#include <trocar/tissue/heat/heat.hpp>

namespace trocar::tissue {

enum class EnergyMode : std::int32_t { off, cut, blend, coag, bipolar };

/// What a wave form does.
struct EnergyCurve {
  double low = 0, high = 0;  ///< load between which the set power is given [Ohm]
  double focus = 1;          ///< radius that current enters through, beside the electrode's
  double reach = 2;          ///< HeatSource::reach
  double gap = 0;            ///< widest gap that sparks cross [m]
  std::int32_t bursts = 0;   ///< 1: a continuous wave, which parts tissue
};
EnergyCurve curve_of(EnergyMode mode) noexcept;

inline constexpr double kMostWatts = 120, kWattStep = 5;  ///< of a setting, our choice

/// No padding: part of a State.
struct GeneratorPanel {
  double yellow_watts = 40;  ///< 0 to kMostWatts
  double blue_watts = 40;    ///< coagulation
  double bipolar_watts = 30;
  EnergyMode yellow = EnergyMode::cut;  ///< or blend
  std::uint32_t held = 0;               ///< keys that were down at the last press()

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("yellow_watts", s.yellow_watts), v("blue_watts", s.blue_watts), v("bipolar_watts", s.bipolar_watts),
        v("yellow", s.yellow), v("held", s.held);
  }
};
static_assert(sizeof(GeneratorPanel) == 3 * 8 + 2 * 4, "no padding");

/// Keys of the panel.
enum PanelKey : std::uint32_t {
  kYellowMore = 1,
  kYellowLess = 2,
  kBlueMore = 4,
  kBlueLess = 8,
  kBipolarMore = 16,
  kBipolarLess = 32,
  kOtherCut = 64,  ///< from cut to blend and back
};
inline constexpr std::uint32_t kPanelKeys = 127;
/// A key that goes down changes its setting by a step of kWattStep, once.
/// @param down  PanelKey bits
void press(std::uint32_t down, GeneratorPanel& panel) noexcept;

struct FootSwitch {
  bool yellow = false, blue = false;  ///< both: nothing flows
};

struct ElectrodeDescription {
  bool bipolar = false;                          ///< jaws with tissue between them; blue pedal
  double radius = 1e-3;                          ///< of the contact [m], 0.5 to 1.5 mm
  double efficiency = 0.45;                      ///< eta, 0.3 to 0.6
  double back = 120;                             ///< [Ohm]; of a monopolar one
  double wet = 320;                              ///< through 1 mm of wet tissue [Ohm]; 60 between jaws
  double tip_capacity = 0.08;                    ///< c [J/K]
  double tip_contact = 0.004;                    ///< G, 4 k r of a disk on tissue and twice that wet [W/K]
  double tip_air = 0.0045;                       ///< G_air [W/K]: cools with 18 s
  double tip_share = 0.02;                       ///< of the generator's power that heats the electrode
  double sticks_from = 150, sticks_fully = 200;  ///< [C]
  double stick_force = 2;                        ///< to tear off what sticks fully [N]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("bipolar", s.bipolar), v("radius", s.radius), v("efficiency", s.efficiency), v("back", s.back), v("wet", s.wet),
        v("tip_capacity", s.tip_capacity), v("tip_contact", s.tip_contact), v("tip_air", s.tip_air),
        v("tip_share", s.tip_share), v("sticks_from", s.sticks_from), v("sticks_fully", s.sticks_fully),
        v("stick_force", s.stick_force);
  }
};
inline constexpr double kHotTip = 42;  ///< touching with a tip above it hurts [C]
ElectrodeDescription bipolar_jaws() noexcept;

/// Where the electrode is at tissue, or how far from it.
struct ElectrodeContact {
  BodyId body;                   ///< none: nothing near
  Vec3d a{0, 0, 0}, b{0, 0, 0};  ///< ends of what touches (a = b: a tip), or both jaws' pads; rest frame [m]
  double gap = 0;                ///< to the tissue; 0 touches [m]
  double pressed = 1;            ///< share of the electrode's radius that is in contact, 0.1 to 1
};

/// What the generator and the electrode are doing.
struct DischargeFigures {
  EnergyMode mode = EnergyMode::off;  ///< what the pedals ask for
  std::int32_t flows = 0;             ///< 1: there is a way for the current
  std::int32_t hot_touch = 0;         ///< 1: the tip touches with more than kHotTip while no pedal is pressed
  std::int32_t unused = 0;            ///< keeps the hash free of padding
  double output = 0;                  ///< of the generator [W]
  double tissue = 0;                  ///< what of it heats tissue [W]
  double impedance = 0;               ///< [Ohm], 0 if nothing flows
  double tear_force = 0;              ///< that tearing off what sticks would take [N]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("mode", s.mode), v("flows", s.flows), v("hot_touch", s.hot_touch), v("unused", s.unused), v("output", s.output),
        v("tissue", s.tissue), v("impedance", s.impedance), v("tear_force", s.tear_force);
  }
};

struct ElectrodeState {
  double tip = kBodyHeat;  ///< [C]
  double stuck = 0;        ///< 0 .. 1
  double joules = 0;       ///< given to tissue as current, since the beginning
  double on_time = 0;      ///< this activation [s]
  DischargeFigures now;

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("tip", s.tip), v("stuck", s.stuck), v("joules", s.joules), v("on_time", s.on_time), v("now", s.now);
  }
};

struct Discharge : DischargeFigures {
  std::array<HeatSource, 2> sources;  ///< for this tick's advance()
  std::int32_t count = 0;
  std::span<const HeatSource> span() const { return {sources.data(), std::size_t(count)}; }
};

EnergyMode asked_mode(const ElectrodeDescription& electrode, const GeneratorPanel& panel, FootSwitch pedals) noexcept;
double set_watts(const GeneratorPanel& panel, EnergyMode mode) noexcept;
/// Share of the set power that the generator gives into a load.
double load_factor(const EnergyCurve& curve, double ohm) noexcept;

/// One tick of an electrode; does not advance the heat.
Discharge energise(const ElectrodeDescription& electrode, const GeneratorPanel& panel, FootSwitch pedals,
                   const ElectrodeContact& contact, const HeatModel& heat_model, const TissueShape& shape,
                   HeatState& heat, HeatWork& work, ElectrodeState& state) noexcept;

/// The same at tissue that keeps its heat by itself, outside the grid: nothing is left there, `tissue` is what it gets.
/// @param met  what the electrode meets there; a volume of 0: nothing
Discharge energise_apart(const ElectrodeDescription& electrode, const GeneratorPanel& panel, FootSwitch pedals,
                         const ElectrodeContact& contact, const HeatContact& met, const HeatModel& heat_model,
                         const HeatState& heat, ElectrodeState& state) noexcept;

/// What stuck was torn off, or washed off.
inline void tear_off(ElectrodeState& state) noexcept { state.stuck = 0; }

void add_to_hash(core::Hasher& hasher, const ElectrodeState& state) noexcept;

}  // namespace trocar::tissue
