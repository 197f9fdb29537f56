#include "commands/mechanisms/study_options.hpp"

#include <cmath>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/text.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/files/scene_folders.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/studies/handles.hpp>

#include "commands/number_options.hpp"

namespace trocar::app {

using namespace studies;
using kinematics::Measure;
using kinematics::Mechanism;

void refuse_words(const std::string& word, const std::string& message) {
  throw core::BadInput({{{word, 0, 0}, message}});
}

std::filesystem::path mechanism_file(const std::string& name) {
  return scene::file_or_name(name, "mechanisms", "mechanism");
}

std::string frame_or_tip(const Mechanism& m, const std::string& given) {
  if (!given.empty() || m.frame_names.empty()) return given;
  return m.frame("tip") >= 0 ? "tip" : m.frame_names.front();
}

std::pair<std::string, double> assignment(const std::string& word) {
  const std::size_t at = word.find('=');
  const std::string number = at == word.npos ? "" : word.substr(at + 1);
  if (at == word.npos || at == 0 || !core::is_decimal(number) || !(std::fabs(core::to_double(number)) <= 1e4))
    refuse_words(word, tr("expected NAME=NUMBER with a number from -10000 to 10000, got \"{}\"", word));
  return {word.substr(0, at), core::to_double(number)};
}

void add_study_options(CLI::App& c, StudyOptions& o) {
  const char* group = tr("Tolerance study");
  c.add_option("--along", o.along, tr("measure the position along x, y, z or a direction X,Y,Z"))
      ->capture_default_str()
      ->group(group);
  c.add_option("--turn", o.turn, tr("measure the rotation about x, y, z or X,Y,Z instead"))->group(group);
  c.add_option("--from", o.from, tr("measure relative to this frame"))->group(group);
  c.add_flag("--distance", o.distance, tr("measure the distance from the frame of --from instead"))->group(group);
  c.add_option("--plus-minus-um", o.plus_minus_um, tr("error of every length [um]; default: the file's"))
      ->check(number_above(0, 1000, "um"))
      ->group(group);
  c.add_option("--plus-minus-deg", o.plus_minus_deg, tr("error of every angle [deg]; default: the file's"))
      ->check(number_above(0, 5, "degrees"))
      ->group(group);
  c.add_flag("--uniform", o.uniform, tr("uniform errors; default: normal, standard deviation 1/3 of the bound"))
      ->group(group);
  c.add_option("--within", o.within, tr("accepted deviation, either way [um or 1/1000 deg]"))
      ->check(number_above(0, 1e6, ""))
      ->group(group);
  c.add_option("--bins", o.bins, tr("bins of the histogram"))
      ->transform(whole_number(2, 500))
      ->capture_default_str()
      ->group(group);
  c.add_option("--seed", o.seed, tr("number from which the errors are drawn"))
      ->transform(whole_number(0, kLargestSeed))
      ->capture_default_str()
      ->group(group);
  c.add_option("--threads", o.threads, tr("number of threads; default: the cores less one"))
      ->transform(whole_number(1, 64))
      ->group(group);
}

StudyUnit unit_of(const Measured& what) {
  if (what.kind == MeasuredKind::turn) return {"mdeg", 180e3 / portable::pi};
  return {};
}

int frame_named(const Mechanism& m, const std::string& name) {
  const int frame = m.frame(name);
  if (frame < 0) refuse_words(name, scene::unknown_name("frame", name, m.frame_names));
  return frame;
}

namespace {

Vec3d direction_of(const std::string& word) {
  if (word == "x") return {1, 0, 0};
  if (word == "y") return {0, 1, 0};
  if (word == "z") return {0, 0, 1};
  Vec3d d;
  std::size_t from = 0;
  int k = 0;
  for (; k < 3 && from <= word.size(); ++k) {
    const std::size_t comma = std::min(word.find(',', from), word.size());
    const std::string number = word.substr(from, comma - from);
    if (!core::is_decimal(number) || !(std::fabs(core::to_double(number)) <= 1e4)) break;
    d[k] = core::to_double(number);
    from = comma + 1;
  }
  if (k < 3 || from <= word.size() || !(length(d) > 1e-6))
    refuse_words(word, tr("expected x, y, z or three numbers X,Y,Z that are not all 0, got \"{}\"", word));
  return (1 / length(d)) * d;
}

std::vector<double> handles_of(const Mechanism& m, const std::vector<std::string>& drives) {
  std::vector<std::string> names;
  for (const kinematics::Drive& d : m.drives) names.push_back(d.name);
  std::vector<double> handles = start_handles(m);
  for (const std::string& word : drives) {
    const auto [name, value] = assignment(word);
    const int d = m.drive(name);
    if (d < 0) refuse_words(word, scene::unknown_name("drive", name, names));
    handles[std::size_t(d)] = value;
  }
  return handles;
}

double shown(Measure measure, double value) {
  return measure == Measure::length ? 1e6 * value : measure == Measure::angle ? value * 180 / portable::pi : value;
}
const char* shown_unit(Measure measure) {
  return measure == Measure::length ? "um" : measure == Measure::angle ? "deg" : "";
}

}  // namespace

StudyTask prepare(const Mechanism& m, const StudyOptions& options) {
  StudyOptions o = options;
  o.frame = frame_or_tip(m, options.frame);
  StudyTask task;
  task.what.frame = frame_named(m, o.frame);
  if (!o.from.empty()) task.what.from = frame_named(m, o.from);
  if (o.distance && o.from.empty()) refuse_words("--distance", "expected --from FRAME with it, got none");
  const std::string seen = o.from.empty() ? "" : " seen from " + o.from;
  if (o.distance) {
    task.what.kind = MeasuredKind::distance;
    task.words = "distance of " + o.frame + " from " + o.from;
  } else if (!o.turn.empty()) {
    task.what.kind = MeasuredKind::turn;
    task.what.direction = direction_of(o.turn);
    task.words = "turn of " + o.frame + " about " + o.turn + seen;
  } else {
    task.what.direction = direction_of(o.along);
    task.words = "place of " + o.frame + " along " + o.along + seen;
  }
  task.unit = unit_of(task.what);
  if (o.within > 0) task.limits = {-o.within / task.unit.by, o.within / task.unit.by};
  task.handles = handles_of(m, o.drives);
  const std::vector<Toleranced> errors = everywhere(m, 1e-6 * o.plus_minus_um, o.plus_minus_deg * portable::pi / 180);
  if (errors.empty())
    refuse_words("--plus-minus-um",
                 "expected errors of dimensions, got none: neither here nor in the file (plus_minus)");
  task.study.emplace(m, task.handles, task.what, errors, o.uniform ? Distribution::uniform : Distribution::normal);
  return task;
}

Json study_json(const StudyTask& t, const std::vector<double>& values, const Statistics& s) {
  const Mechanism& m = t.study->mechanism();
  const LinearTolerance& l = t.study->linear();
  const double by = t.unit.by;
  Json ranked = Json::array(), misfits = Json::array(), percentiles = Json::array();
  for (const Sensitivity& x : l.ranked) {
    const kinematics::Parameter& p = m.parameters[std::size_t(x.parameter)];
    ranked.push_back({{"name", p.name},
                      {"plus_minus", shown(p.measure, x.plus_minus)},
                      {"unit", shown_unit(p.measure)},
                      {"effect", by * x.effect()},
                      {"share", x.share}});
  }
  for (const Misfit& x : t.study->misfits()) misfits.push_back(m.parameters[std::size_t(x.parameter)].name);
  for (std::size_t k = 0; k < kPercentiles.size(); ++k)
    percentiles.push_back({{"percent", kPercentiles[k]}, {"deviation", by * s.percentiles[k]}});
  return {{"name", m.name},
          {"kind", "tolerance"},
          {"measured", t.words},
          {"unit", t.unit.name},
          {"nominal", t.what.kind == MeasuredKind::turn ? 0 : 1e3 * l.nominal},
          {"nominal_unit", t.what.kind == MeasuredKind::turn ? "deg" : "mm"},
          {"linear", {{"worst", by * l.worst}, {"rss", by * l.rss}, {"deviation", by * l.deviation}}},
          {"samples", s.samples},
          {"open", s.open},
          {"mean", by * s.mean},
          {"deviation", by * s.deviation},
          {"skewness", s.skewness},
          {"low", by * s.low},
          {"high", by * s.high},
          {"percentiles", percentiles},
          {"bins", s.bins},
          {"within", std::isfinite(t.limits.high) ? Json(by * t.limits.high) : Json(nullptr)},
          {"yield", s.yield},
          {"bits", core::hex(core::hash_bytes(values.data(), values.size() * sizeof(double)))},
          {"sensitivities", ranked},
          {"misfits", misfits}};
}

}  // namespace trocar::app
