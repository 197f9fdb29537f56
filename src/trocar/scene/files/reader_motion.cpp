// What moves by itself in a scene: waves of hollow organs, breathing.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/scene/files/reader_parts.hpp>

namespace trocar::scene {
namespace {

/// Two waves nearer to each other than this many widths would be one broad contraction.                    Our choice
constexpr double kWidthsApart = 2;

void check_widths(const JsonObject& o, const WaveSetting& w) {
  for (const WaveSetting::Station& s : w.stations) {
    const double apart = s.speed * 60 / w.per_minute;
    if (!(w.width * kWidthsApart > apart)) continue;
    o.fault("width_mm", fmt::format("expected at most half the way from wave to wave, {:.3g} mm ({} mm/s at {} per "
                                    "minute), got {}",
                                    1000 * apart, 1000 * s.speed, w.per_minute, 1000 * w.width));
    return;
  }
}

}  // namespace

void Reading::wave(const JsonObject& o) {
  WaveSetting w;
  refer(Reference::To::solid, o, "solid");
  w.solid = o.text("solid");
  w.centreline = from_mm(o.points("centreline_mm"));
  for (const JsonObject& s : o.objects("stations")) {
    w.stations.push_back({from_mm(s.number("s_mm")), 1000 * s.number("pressure_kPa"),
                          from_mm(s.number("speed_mm_s", 10)), s.at("s_mm")});
    const std::size_t n = w.stations.size();
    if (n > 1 && s.has("s_mm") && !(w.stations[n - 1].s > w.stations[n - 2].s))
      s.fault("s_mm", fmt::format("expected more than the station before, {} mm, got {}", 1000 * w.stations[n - 2].s,
                                  1000 * w.stations[n - 1].s));
  }
  w.per_minute = o.number("per_minute", w.per_minute);
  w.width = from_mm(o.number("width_mm", 10));
  w.first = o.number("first_s", w.first);
  w.cycle = o.number("cycle_s", w.cycle);
  w.active_share = o.number("active_share", w.active_share);
  w.at = o.at();
  w.solid_at = o.at("solid");
  w.centreline_at = o.at("centreline_mm");
  for (std::size_t i = 1; i < w.centreline.size(); ++i)
    if (!(length(w.centreline[i] - w.centreline[i - 1]) >= 1e-5)) {
      o.fault(o.at("centreline_mm", i), "expected a point at least 0.01 mm from the one before, got the same place");
      w.centreline.clear();
    }
  check_widths(o, w);
  description.peristalsis.push_back(std::move(w));
}

void Reading::breathing(const JsonObject& o) {
  BreathingSetting b;
  b.per_minute = o.number("per_minute", b.per_minute);
  b.amplitude = from_mm(o.number("amplitude_mm", 10));
  b.direction = o.vec3("direction", b.direction);
  if (!(length(b.direction) > 1e-6)) {
    o.fault("direction", "expected a direction, got none");
    b.direction = BreathingSetting{}.direction;
  }
  for (const JsonObject& c : o.objects("carries")) {
    refer(Reference::To::carrier, c, "body");
    b.carries.push_back({c.text("body"), c.number("share", 1), c.at("body")});
    for (std::size_t i = 0; i + 1 < b.carries.size(); ++i)
      if (c.has("body") && b.carries[i].body == b.carries.back().body)
        c.fault("body", fmt::format("expected every body once, got \"{}\" again", b.carries.back().body));
  }
  b.at = o.at();
  description.breathing = std::move(b);
}

/// Do its organ and its stations fit it?
void Reading::check_wave(const WaveSetting& wave) {
  for (const Solid& solid : description.solids) {
    if (solid.name != wave.solid || wave.solid.empty()) continue;
    if (solid.cuttable)
      tell(m_faults, {wave.solid_at, fmt::format("expected a solid that is not cuttable, got \"{}\"", solid.name)});
    std::vector<Vec3d> line = wave.centreline;
    if (line.empty())
      for (const Section& s : solid.sections) line.push_back(s.centre);
    if (line.size() < 2) {
      tell(m_faults, {wave.at, fmt::format("expected \"centreline_mm\" for \"{}\", which has no sections, got none",
                                           solid.name)});
      continue;
    }
    const double whole = curve_length(line);
    for (const WaveSetting::Station& s : wave.stations)
      if (beyond(s.s, whole))
        tell(m_faults, {s.at, fmt::format("expected a way on the centre line (at most {:.1f} mm), got {}", whole * 1000,
                                          s.s * 1000)});
  }
}

}  // namespace trocar::scene
