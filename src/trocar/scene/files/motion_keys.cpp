// Keys of what moves by itself in a scene (waves of hollow organs, breathing), and of how finely things are drawn.
#include <algorithm>

#include <trocar/core/text.hpp>
#include <trocar/scene/files/keys.hpp>

namespace trocar::scene {
namespace {

using Station = WaveSetting::Station;

const Table<Station>& wave_station() {
  using R = Rows<Station>;
  static const Table<Station> table{
      "wave station",
      "The waves at one point of the centre line; linear between stations.",
      {needed(
           R::number("s_mm", units::mm, &Station::s, 0, 5000, "arc length along the centre line").placed(&Station::at)),
       needed(R::number("pressure_kPa", units::kilo, &Station::pressure, 0, 100, "pressure of a crest on the wall")),
       needed(R::number("speed_mm_s", units::mm, &Station::speed, 0.1, 200, "speed of the waves there"))}};
  return table;
}

void check_wave_station(const JsonObject& o, WaveSetting& w, Context&) {
  const std::size_t n = w.stations.size();
  if (n > 1 && o.has("s_mm") && !(w.stations[n - 1].s > w.stations[n - 2].s))
    o.fault("s_mm", tr("expected more than the station before, {} mm, got {}", 1000 * w.stations[n - 2].s,
                       1000 * w.stations[n - 1].s));
}

/// Two waves nearer to each other than this many widths would be one broad contraction.                    Our choice
constexpr double kWidthsApart = 2;

void check_wave(const JsonObject& o, WaveSetting& w, Context&) {
  if (!check_apart(o, "centreline_mm", w.centreline)) w.centreline.clear();
  for (const Station& s : w.stations) {
    const double apart = s.speed * 60 / w.per_minute;
    if (!(w.width * kWidthsApart > apart)) continue;
    o.fault("width_mm", tr("expected at most half of the wavelength, {:.3g} mm ({} mm/s at {} per "
                           "minute), got {}",
                           1000 * apart, 1000 * s.speed, w.per_minute, 1000 * w.width));
    return;
  }
}

using Carried = BreathingSetting::Carried;

const Table<Carried>& carried() {
  using R = Rows<Carried>;
  static const Table<Carried> table{
      "carried body",
      "A body whose fixed points move with breathing.",
      {needed(R::ref("body", Reference::To::carrier, &Carried::body, "a solid, strand, membrane or pouch")
                  .placed(&Carried::at)),
       R::number("share", units::one, &Carried::share, 0, 1, "of the amplitude, default {}")}};
  return table;
}

void check_carried(const JsonObject& o, BreathingSetting& b, Context&) {
  for (std::size_t i = 0; i + 1 < b.carries.size(); ++i)
    if (o.has("body") && b.carries[i].body == b.carries.back().body)
      o.fault("body", tr("expected every body once, got \"{}\" again", b.carries.back().body));
}

using Level = DetailSetting::Level;
constexpr std::size_t kMostLevels = 8;

const Table<Level>& level() {
  using R = Rows<Level>;
  static const Table<Level> table{
      "level of detail",
      "Detail of a body from a distance on.",
      {needed(R::number("from_mm", units::mm, &Level::from, 1, kFar, "its distance from the endoscope's tip")),
       needed(R::number("error_mm", units::mm, &Level::error, 0.001, 20,
                        "largest deviation of its surface from the full one")),
       R::integer("surface", &Level::surface, 0, 2,
                  "patterns: 2 all, 1 no fine flecks, 0 no vessels either; default {}")}};
  return table;
}

/// From one level to the next things are further away, and not finer.
void check_level(const JsonObject& o, DetailSetting& d, Context&) {
  if (d.levels.size() < 2) return;
  const Level &now = d.levels.back(), &before = d.levels[d.levels.size() - 2];
  if (o.has("from_mm") && !(now.from > before.from))
    o.fault("from_mm",
            tr("expected more than the level before, {} mm, got {}", 1000 * before.from, o.number("from_mm")));
  if (o.has("error_mm") && now.error < before.error)
    o.fault("error_mm",
            tr("expected no less than the level before, {} mm, got {}", 1000 * before.error, o.number("error_mm")));
  if (now.surface > before.surface)
    o.fault("surface", tr("expected no more than the level before, {}, got {}", before.surface, now.surface));
}

void check_detail(const JsonObject& o, DetailSetting& d, Context&) {
  if (o.has("of") && d.of.empty()) o.fault("of", "expected the name of something, got none");
  if (d.levels.size() > kMostLevels)
    o.fault("levels", tr("expected at most {} levels, got {}", kMostLevels, d.levels.size()));
}

}  // namespace

const Table<WaveSetting>& wave() {
  using R = Rows<WaveSetting>;
  using W = WaveSetting;
  static const Table<W> table{
      "waves",
      "Peristalsis of a hollow organ: rings of contraction that run along it. From one to the next it is speed over "
      "frequency.",
      {needed(R::ref("solid", Reference::To::solid, &W::solid, "the organ: a solid that is not cuttable")
                  .placed(&W::solid_at)),
       R::points("centreline_mm", units::mm, &W::centreline, -kFar, kFar, 2,
                 "along the lumen, in the waves' direction, default: the centres of the solid's sections")
           .placed(&W::centreline_at),
       needed(R::objects("stations", wave_station, &W::stations, 1, "by rising s_mm", check_wave_station)),
       needed(R::number("per_minute", units::one, &W::per_minute, 0.1, 60, "waves that begin")),
       R::number("width_mm", units::mm, &W::width, 1, 100, "sigma of a wave's Gaussian profile, default {}"),
       R::number("first_s", units::one, &W::first, 0, 36000,
                 "time at which a crest is at the centre line's start, default {}"),
       R::number("cycle_s", units::one, &W::cycle, 1, 36000, "period of activity and rest, default {}"),
       R::number("active_share", units::one, &W::active_share, 0, 1,
                 "active share of the period, default {}: always active")},
      check_wave};
  return table;
}

const Table<BreathingSetting>& breathing() {
  using R = Rows<BreathingSetting>;
  using B = BreathingSetting;
  static const Table<B> table{
      "breathing",
      "Breathing: bodies carried by the diaphragm move to and fro; a scene starts at the end of an expiration.",
      {needed(R::number("per_minute", units::one, &B::per_minute, 1, 60, "breaths")),
       needed(R::number("amplitude_mm", units::mm, &B::amplitude, 0, 50,
                        "from the end of an expiration to that of an inspiration")),
       R::vec3("direction", units::one, &B::direction, -1, 1,
               "of inspiration, any length, default {}: towards the feet"),
       needed(R::objects("carries", carried, &B::carries, 1, "bodies that move with it", check_carried))},
      [](const JsonObject& o, B& b, Context&) {
        if (length(b.direction) > 1e-6) return;
        o.fault("direction", "expected a direction, got none");
        b.direction = B{}.direction;
      }};
  return table;
}

const Table<DetailSetting>& detail() {
  using R = Rows<DetailSetting>;
  static const Table<DetailSetting> table{
      "detail",
      "Level of detail by distance. Distances are for a picture 600 px high and a "
      "lens "
      "of 70 degrees; in other pictures the level changes at the same size on screen. The physics does not depend on "
      "it.",
      {needed(R::refs("of", Reference::To::drawn, &DetailSetting::of,
                      "bodies, walls, instruments, ports (for their sleeves), cavity, endoscope, arteries, veins")),
       needed(R::objects("levels", level, &DetailSetting::levels, 0, "by rising from_mm; none: always in full",
                         check_level))},
      check_detail};
  return table;
}

}  // namespace trocar::scene
