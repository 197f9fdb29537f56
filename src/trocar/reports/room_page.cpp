#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/reports/design_page.hpp>
#include <trocar/reports/page_template.hpp>
#include <trocar/reports/report_svg.hpp>
#include <trocar/reports/room_page.hpp>

namespace trocar::reports {

using namespace studies;

namespace {

constexpr double kShownClearance = 0.15;  // [m] more is drawn as this

Json room_table(const std::string& caption, std::vector<std::string> columns,
                const std::vector<std::vector<std::string>>& lines) {
  Json rows = Json::array();
  for (const std::vector<std::string>& line : lines) rows.push_back({{"cells", line}});
  return {{"caption", caption}, {"columns", std::move(columns)}, {"lines", rows}};
}

std::string figures_html(const std::vector<RoomPicture>& pictures) {
  std::string html;
  for (const RoomPicture& p : pictures)
    html += fmt::format(
        "<figure><img src=\"{}\" alt=\"{}\" style=\"max-width:100%\"><figcaption>{}</figcaption></figure>\n",
        escaped(p.file), escaped(p.words), escaped(p.words));
  return html;
}

Plot over_time(const RoomModel& model, const MotionReport& r, const std::string& id, const std::string& title,
               const std::string& label, double (*value)(const MotionStep::Arm&)) {
  Plot plot;
  plot.id = id;
  plot.title = title;
  plot.description = title + ", a line an arm";
  plot.x_label = "time [s]";
  plot.y_label = label;
  for (std::size_t a = 0; a < model.arms().size(); ++a) {
    Series line{model.arms()[a].described->name, {}, {}, int(a % 6)};
    for (const MotionStep& s : r.steps) {
      line.x.push_back(s.at);
      line.y.push_back(value(s.arms[a]));
    }
    plot.series.push_back(std::move(line));
  }
  for (const MotionFault& f : r.faults) plot.marks.push_back({f.from, word_of(f.kind), true});
  plot.height = 220;
  return plot;
}

}  // namespace

std::string motion_html(const RoomModel& model, const MotionReport& r, const std::string& led_by,
                        const std::vector<RoomPicture>& pictures) {
  Json sections = Json::array();
  if (!pictures.empty())
    sections.push_back({{"heading", "Seen from the feet"}, {"drawing", figures_html(pictures)}, {"legend", ""}});
  std::vector<std::vector<std::string>> lines;
  for (const MotionFault& f : r.faults)
    lines.push_back({fmt::format("{:.2f} to {:.2f}", f.from, f.to), word_of(f.kind),
                     f.arm >= 0 ? model.arms()[std::size_t(f.arm)].described->name : "table", f.words});
  Json faults{{"heading", "Where it fails"}};
  if (lines.empty())
    faults["note"] = "Nowhere: every step is within reach, limits and speeds, and clear.";
  else
    faults["table"] = room_table("Faults in order of time", {"time [s]", "kind", "arm", "what"}, lines);
  sections.push_back(std::move(faults));
  const Plot clear = over_time(model, r, "clearance", "Clearance of each arm", "clearance [mm]",
                               [](const MotionStep::Arm& a) { return 1e3 * std::min(a.clearance, kShownClearance); });
  sections.push_back({{"heading", "Clearance"},
                      {"drawing", svg(clear)},
                      {"legend", legend(clear.series)},
                      {"note", tr("Least: {:.1f} mm at {:.2f} s, {}. More than {:.0f} mm is drawn as that.",
                                  1e3 * r.least_clearance, r.least_at, r.least_pair, 1e3 * kShownClearance)}});
  const Plot speed = over_time(model, r, "speed", "Speed of the fastest coordinate, of what is allowed", "share",
                               [](const MotionStep::Arm& a) { return a.speed; });
  sections.push_back({{"heading", "Speed"}, {"drawing", svg(speed)}, {"legend", legend(speed.series)}});
  return fill(page_text("design.html"),
              {{"title", fmt::format("{}: {}", model.room().name, led_by)},
               {"lead",
                {tr("{:.2f} s in {} steps: {}.", r.length, r.count, r.good() ? "it can be done" : "it cannot be done"),
                 tr("Shafts pass their ports by at most {:.2g} mm; loops stand open by at most {:.1e} m.",
                    1e3 * r.port_gap, r.loop_gap)}},
               {"sections", std::move(sections)},
               {"version", TROCAR_VERSION}});
}

std::string plan_html(const RoomModel& model, const PortPlan& plan, const std::vector<RoomPicture>& pictures) {
  const auto deg = [](double angle) { return fmt::format("{:.0f}", angle * 180 / portable::pi); };
  const auto at = [](Vec3d v) { return fmt::format("{:.0f}, {:.0f}, {:.0f}", 1e3 * v.x, 1e3 * v.y, 1e3 * v.z); };
  std::vector<std::vector<std::string>> lines;
  for (const PortPair& p : plan.pairs) {
    const PortCandidate &l = plan.candidates[std::size_t(p.left)], &r = plan.candidates[std::size_t(p.right)];
    const auto ways = [](const WaysIn& w) {
      return w.blocked > 0 ? fmt::format("{:.0f} % by {}", 100 * w.blocked, w.first) : std::string("free");
    };
    lines.push_back({fmt::format("{:.3f}", p.score), at(l.place), at(r.place), deg(p.manipulation),
                     deg(l.azimuth) + ", " + deg(r.azimuth), deg(l.elevation) + ", " + deg(r.elevation),
                     fmt::format("{:.2f}, {:.2f}", l.lever, r.lever),
                     fmt::format("{:.0f}", 1e3 * std::min(p.clearance, p.patient_clearance)),
                     ways(l.ways) + ", " + ways(r.ways),
                     p.with_arms ? fmt::format("{:.0f} %, {:.0f} mm, {} and {}", 100 * p.arms_reach,
                                               1e3 * p.arms_clearance, deg(p.turned[0]), deg(p.turned[1]))
                                 : "-"});
  }
  Json sections = Json::array();
  sections.push_back({{"heading", "On the abdomen"}, {"drawing", figures_html(pictures)}, {"legend", ""}});
  sections.push_back(
      {{"heading", "The best sets"},
       {"table",
        room_table("Pairs of ports for the left and the right hand",
                   {"rank", "score", "left [mm]", "right [mm]", "manipulation [deg]", "azimuths [deg]",
                    "elevations [deg]", "levers", "clear [mm]", "ways in", "arms: reach, clear, bases turned [deg]"},
                   lines)},
       {"note",
        "Best are a manipulation angle of 60 degrees, equal azimuths and an elevation of 60 degrees (Hanna, Shimi and "
        "Cuschieri 1997); the cost of a departure is our estimate."}});
  return fill(page_text("design.html"),
              {{"title", tr("{}: where to put ports", model.room().name)},
               {"lead",
                {tr("{} places on the skin, {} pairs; target at {} mm, endoscope at {} mm.", plan.candidates.size(),
                    plan.looked_at, at(plan.target), at(plan.scope))}},
               {"sections", std::move(sections)},
               {"version", TROCAR_VERSION}});
}

std::string write_room_page(const std::filesystem::path& folder, const std::string& html) {
  return write_design_page(folder, html);
}

}  // namespace trocar::reports
