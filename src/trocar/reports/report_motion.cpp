#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/reports/labels.hpp>
#include <trocar/reports/report_motion.hpp>
#include <trocar/reports/report_svg.hpp>
#include <trocar/training/metrics/metrics.hpp>
#include <trocar/training/metrics/metrics_parts.hpp>

namespace trocar::reports {
namespace {

using training::Trace;
using training::TraceHand;

constexpr double kFewest = 3;              // samples that make a motion
constexpr std::size_t kPathPoints = 1500;  // of a path on the page
constexpr double kLeastShown = 0.1;        // [N] forces below are not worth a curve

double size_of(Vec3d v) { return length(v); }

std::string hand_title(const Trace& trace, std::size_t hand) { return in_plain_words(trace.hands[hand].name, true); }

/// Every so many samples, so that no path has more than kPathPoints.
std::size_t stride_of(const Trace& trace) { return trace.size() / kPathPoints + 1; }

struct Box {
  Vec3d low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  void take(Vec3d v) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
};

Vec3d mm(Vec3d v) { return 1000 * v; }

Box box_of(const Trace& trace) {
  Box box;
  for (const TraceHand& hand : trace.hands)
    for (const training::TraceSample& s : hand.samples) box.take(mm(s.tip));
  return box;
}

Json views(const Trace& trace, const Box& box) {
  struct View {
    const char *id, *title, *right, *up;
    double Vec3d::*x;
    double Vec3d::*y;
    double sign;
  };
  static constexpr View kViews[] = {
      {"view-front", "From the front", "patient's left", "cranial", &Vec3d::x, &Vec3d::y, 1},
      {"view-feet", "From the feet", "patient's left", "anterior", &Vec3d::x, &Vec3d::z, 1},
      {"view-side", "From the left", "cranial", "anterior", &Vec3d::y, &Vec3d::z, 1}};
  Json out = Json::array();
  for (const View& v : kViews) {
    Projection p;
    p.id = v.id;
    p.title = tr(v.title);
    p.description = tr("Paths of the instrument tips, seen along one axis.");
    p.right = tr(v.right);
    p.up = tr(v.up);
    p.low[0] = box.low.*v.x, p.high[0] = box.high.*v.x;
    p.low[1] = box.low.*v.y, p.high[1] = box.high.*v.y;
    for (std::size_t h = 0; h < trace.hands.size(); ++h) {
      Series s{hand_title(trace, h), {}, {}, int(h % 6)};
      for (std::size_t i = 0; i < trace.size(); i += stride_of(trace)) {
        const Vec3d tip = mm(trace.hands[h].samples[i].tip);
        s.x.push_back(v.sign * tip.*v.x);
        s.y.push_back(tip.*v.y);
      }
      p.paths.push_back(std::move(s));
    }
    out.push_back({{"drawing", svg(p)}, {"title", tr(v.title)}});
  }
  return out;
}

/// The paths as data for the page's script.
std::string turnable(const Trace& trace, const Box& box) {
  const Vec3d centre = 0.5 * (box.low + box.high);
  const double radius = std::max(1.0, 0.5 * length(box.high - box.low));
  const auto rounded = [](double v) { return std::round(v * 10) / 10; };
  Json data{{"centre", {rounded(centre.x), rounded(centre.y), rounded(centre.z)}},
            {"radius", rounded(radius)},
            {"axes", {"left", "cranial", "anterior"}},
            {"paths", Json::array()}};
  for (std::size_t h = 0; h < trace.hands.size(); ++h) {
    Json points = Json::array();
    for (std::size_t i = 0; i < trace.size(); i += stride_of(trace)) {
      const Vec3d tip = mm(trace.hands[h].samples[i].tip);
      points.push_back({rounded(tip.x), rounded(tip.y), rounded(tip.z)});
    }
    data["paths"].push_back({{"style", int(h % 6)}, {"points", points}});
  }
  std::string json = data.dump(-1, ' ', false, Json::error_handler_t::replace);
  // No text of ours can end the script element that it stands in.
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
  return json;
}

std::vector<double> times(const Trace& trace) {
  std::vector<double> t(trace.size());
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = trace.time(i);
  return t;
}

std::vector<PlotMark> error_marks(const Json& result) {
  std::vector<PlotMark> marks;
  const Json::json_pointer at("/assessment/errors");
  if (!result.contains(at) || !result[at].is_array()) return marks;
  for (const Json& e : result[at])
    if (e.is_object() && e.contains("at_s") && e["at_s"].is_number())
      marks.push_back({e["at_s"].get<double>(), text_in(e, "code"), true});
  return marks;
}

std::string speeds(const Report& r, const std::vector<double>& t) {
  Plot p;
  p.id = "speed";
  p.title = tr("Speed of each instrument tip");
  p.x_label = tr("Time since the start [s]");
  p.y_label = tr("Speed [mm/s]");
  p.x_from = std::min(0.0, t.front());
  p.x_to = t.back();
  double fastest = 0;
  for (std::size_t h = 0; h < r.trace->hands.size(); ++h) {
    Series s{hand_title(*r.trace, h), t, training::filtered_motion(r.trace->hands[h], r.trace->rate).speed, int(h % 6)};
    for (double& v : s.y) fastest = std::max(fastest, v *= 1000);
    p.series.push_back(std::move(s));
  }
  p.description = tr("Up to {:.0f} mm/s. Smoothed at {:.0f} Hz.", fastest, training::kMotionCutoff);
  p.levels = {{1000 * training::kMovingSpeed, tr("moving")}};
  p.marks = error_marks(r.result);
  return svg(p);
}

Json forces(const Report& r, const std::vector<double>& t) {
  struct Kind {
    const char *key, *title, *what;
    double (*size)(const training::TraceSample&);
  };
  static constexpr Kind kKinds[] = {
      {"pull", "Pull", "of grasped tissue on the jaws", [](const training::TraceSample& s) { return size_of(s.pull); }},
      {"pinch", "Pinch", "between the jaws", [](const training::TraceSample& s) { return s.pinch; }},
      {"contact", "Contact", "of touched tissue on the instrument",
       [](const training::TraceSample& s) { return size_of(s.contact); }}};
  Json out = Json::array();
  for (const Kind& k : kKinds) {
    Plot p;
    p.id = fmt::format("force-{}", k.key);
    p.title = tr("{}: force {}", tr(k.title), tr(k.what));
    p.x_label = tr("Time since the start [s]");
    p.y_label = tr("Force [N]");
    p.x_from = std::min(0.0, t.front());
    p.x_to = t.back();
    p.height = 160;
    double most = 0;
    for (std::size_t h = 0; h < r.trace->hands.size(); ++h) {
      Series s{hand_title(*r.trace, h), t, {}, int(h % 6)};
      for (const training::TraceSample& sample : r.trace->hands[h].samples) s.y.push_back(k.size(sample));
      most = std::max(most, *std::max_element(s.y.begin(), s.y.end()));
      p.series.push_back(std::move(s));
    }
    if (most < kLeastShown) {
      out.push_back({{"title", p.title}, {"none", fmt::format("{}", kLeastShown)}});
      continue;
    }
    p.description = tr("At most {:.2f} N.", most);
    if (const auto limit = number_in(r.result, tr("/metrics/both/forces/{}/limit_N", k.key)))
      if (*limit < 4 * most) p.levels = {{*limit, tr("limit {:.3g} N", *limit)}};
    p.marks = error_marks(r.result);
    out.push_back({{"name", tr(k.title)}, {"what", tr(k.what)}, {"drawing", svg(p)}});
  }
  return out;
}

}  // namespace

Json motion_data(const Report& r) {
  if (!r.trace || double(r.trace->size()) < kFewest || r.trace->hands.empty()) return nullptr;
  std::vector<Series> hands;
  for (std::size_t h = 0; h < r.trace->hands.size(); ++h)
    hands.push_back({hand_title(*r.trace, h), {}, {}, int(h % 6)});
  const Box box = box_of(*r.trace);
  const std::vector<double> t = times(*r.trace);
  return {{"legend", legend(hands)},
          {"paths", turnable(*r.trace, box)},
          {"views", views(*r.trace, box)},
          {"speed", speeds(r, t)},
          {"forces", forces(r, t)}};
}

}  // namespace trocar::reports
