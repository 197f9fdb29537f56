#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/reports/page_template.hpp>
#include <trocar/reports/report_svg.hpp>

namespace trocar::reports {
namespace {

constexpr double kLeft = 56, kRight = 14, kTop = 12, kBottom = 38;

struct Span {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void take(double v) {
    if (!std::isfinite(v)) return;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  bool empty() const { return low > high; }
};

std::vector<double> ticks(double from, double to, int wanted, bool whole) {
  std::vector<double> out;
  if (!(to > from)) return {from};
  double step = tick_step(to - from, wanted);
  if (whole) step = std::max(1.0, std::round(step));
  for (double t = std::ceil(from / step - 1e-9) * step; t <= to + step * 1e-9; t += step)
    out.push_back(std::fabs(t) < step * 1e-9 ? 0 : t);
  return out;
}

std::string number(double v) { return fmt::format("{:.6g}", v); }

std::string head(const std::string& id, const std::string& title, const std::string& description, double width,
                 double height) {
  return fmt::format(
      "<svg id=\"{0}\" viewBox=\"0 0 {3:.0f} {4:.0f}\" role=\"img\" aria-labelledby=\"{0}-t {0}-d\">"
      "<title id=\"{0}-t\">{1}</title><desc id=\"{0}-d\">{2}</desc>\n",
      escaped(id), escaped(title), escaped(description), width, height);
}

std::string text(double x, double y, const char* kind, const char* anchor, const std::string& what) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"{}\" text-anchor=\"{}\">{}</text>", x, y, kind, anchor,
                     escaped(what));
}

std::string line(double x1, double y1, double x2, double y2, const char* kind) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"{}\"/>", x1, y1, x2, y2,
                     kind);
}

/// Data to picture.
struct Frame {
  double x0, x1, y0, y1;            // data
  double left, right, top, bottom;  // picture
  double x(double v) const { return left + (v - x0) / (x1 - x0) * (right - left); }
  double y(double v) const { return bottom - (v - y0) / (y1 - y0) * (bottom - top); }
};

std::string path(const Series& s, const Frame& f) {
  std::string out = fmt::format("<path class=\"line s{}\" d=\"", s.style);
  bool pen = false;
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    if (!std::isfinite(s.x[i]) || !std::isfinite(s.y[i])) {
      pen = false;
      continue;
    }
    out += fmt::format("{}{:.1f} {:.1f}", pen ? "L" : "M", f.x(s.x[i]), f.y(s.y[i]));
    pen = true;
  }
  return out + "\"/>\n";
}

/// A mark whose shape says good or bad without colour: a bar for what happened, a triangle for an error.
std::string mark(double x, double y, const PlotMark& m) {
  return m.bad ? fmt::format("<path class=\"bad\" d=\"M{:.1f} {:.1f}l6 11h-12z\"><title>{}</title></path>", x, y,
                             escaped(m.name))
               : fmt::format("<path class=\"event\" d=\"M{:.1f} {:.1f}v10\"><title>{}</title></path>", x, y,
                             escaped(m.name));
}

/// Letters of a UTF-8 text.
std::size_t letters(const std::string& text) {
  return std::size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string first_letters(const std::string& text, std::size_t most) {
  if (letters(text) <= most) return text;
  std::size_t bytes = 0;
  for (std::size_t seen = 0; bytes < text.size(); ++bytes)
    if ((text[bytes] & 0xc0) != 0x80 && seen++ == most - 1) break;
  return text.substr(0, bytes) + "…";
}

}  // namespace

std::string minutes(double seconds) {
  const int whole = std::isfinite(seconds) ? int(std::lround(std::clamp(seconds, -1e6, 1e6))) : 0;
  return fmt::format("{}{}:{:02}", whole < 0 ? "-" : "", std::abs(whole) / 60, std::abs(whole) % 60);
}

Series thinned(const Series& s, int columns) {
  if (s.x.size() <= std::size_t(4 * columns)) return s;
  Series out{s.name, {}, {}, s.style};
  const std::size_t n = s.x.size();
  for (int c = 0; c < columns; ++c) {
    const std::size_t from = n * std::size_t(c) / std::size_t(columns);
    const std::size_t to = n * std::size_t(c + 1) / std::size_t(columns);
    std::size_t low = from, high = from;
    for (std::size_t i = from; i < to; ++i) {
      if (s.y[i] < s.y[low]) low = i;
      if (s.y[i] > s.y[high]) high = i;
    }
    std::size_t take[] = {from, std::min(low, high), std::max(low, high), to - 1};
    for (std::size_t k = 0; k < 4; ++k)
      if (k == 0 || take[k] > take[k - 1]) {
        out.x.push_back(s.x[take[k]]);
        out.y.push_back(s.y[take[k]]);
      }
  }
  return out;
}

std::string legend(const std::vector<Series>& series) {
  std::string out = "<p class=\"legend\">";
  for (const Series& s : series)
    out += fmt::format(
        "<span><svg viewBox=\"0 0 28 8\" aria-hidden=\"true\"><path class=\"line s{}\" d=\"M0 4H28\"/></svg> "
        "{}</span> ",
        s.style, escaped(s.name));
  return out + "</p>\n";
}

double tick_step(double length, int wanted) {
  const double rough = length / std::max(1, wanted);
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double m : {1.0, 2.0, 5.0})
    if (rough <= m * power * 1.0001) return m * power;
  return 10 * power;
}

std::string svg(const Plot& p) {
  Span x, y;
  for (const Series& s : p.series) {
    for (const double v : s.x) x.take(v);
    for (const double v : s.y) y.take(v);
  }
  for (const Level& l : p.levels) y.take(l.y);
  if (p.x_from != p.x_to) x = {p.x_from, p.x_to};
  if (p.y_from != p.y_to) y = {p.y_from, p.y_to};
  if (x.empty() || y.empty()) return "<p class=\"note\">" + escaped(tr("Nothing to draw.")) + "</p>\n";
  if (p.y_from == p.y_to) {
    y.take(0);
    y.high += (y.high - y.low) * 0.06;
  }
  if (!(x.high > x.low)) x = {x.low - 1, x.high + 1};
  if (!(y.high > y.low)) y.high = y.low + 1;
  if (p.points) {
    const double room = std::max(0.5, 0.03 * (x.high - x.low));
    x = {x.low - room, x.high + room};
  }
  const Frame f{x.low, x.high, y.low, y.high, kLeft, p.width - kRight, kTop, p.height - kBottom};

  std::string out = head(p.id, p.title, p.description, p.width, p.height);
  for (const double t : ticks(y.low, y.high, 4, false)) {
    out += line(f.left, f.y(t), f.right, f.y(t), "grid");
    out += text(f.left - 6, f.y(t) + 4, "tick", "end", number(t));
  }
  for (const double t : ticks(x.low, x.high, p.points ? 10 : 9, p.whole_x)) {
    out += line(f.x(t), f.bottom, f.x(t), f.bottom + 4, "axis");
    out += text(f.x(t), f.bottom + 16, "tick", "middle", number(t));
  }
  out += line(f.left, f.bottom, f.right, f.bottom, "axis") + "\n";
  out += text((f.left + f.right) / 2, p.height - 6, "label", "middle", p.x_label);
  out += fmt::format(
      "<text transform=\"translate(13 {:.1f}) rotate(-90)\" class=\"label\" text-anchor=\"middle\">{}</text>\n",
      (f.top + f.bottom) / 2, escaped(p.y_label));
  for (const Level& l : p.levels) {
    out += line(f.left, f.y(l.y), f.right, f.y(l.y), "level");
    out += text(f.right - 2, f.y(l.y) - 4, "tick", "end", l.name) + "\n";
  }
  for (const Series& s : p.series) {
    out += path(p.points ? s : thinned(s, p.width), f);
    if (!p.points) continue;
    for (std::size_t i = 0; i < s.x.size(); ++i)
      if (std::isfinite(s.y[i]))
        out += fmt::format(
            "<circle class=\"dot s{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"><title>{}: {}</title></circle>", s.style,
            f.x(s.x[i]), f.y(s.y[i]), int(i) == p.emphasised ? 6 : 3.5, number(s.x[i]), number(s.y[i]));
    out += "\n";
  }
  for (const PlotMark& m : p.marks)
    if (m.x >= x.low && m.x <= x.high) out += mark(f.x(m.x), f.bottom - 11, m);
  return out + "</svg>\n";
}

std::string svg(const Timeline& t) {
  constexpr double kWidth = 760, kLane = 26, kLetter = 6.2, kLeastName = 60, kMostName = 240;
  std::vector<std::string> lanes;
  double longest = 0;  // a lane's name is never cut: the column is as wide as they are
  for (const TimelineBar& b : t.bars)
    if (std::find(lanes.begin(), lanes.end(), b.lane) == lanes.end()) lanes.push_back(b.lane);
  for (const std::string& lane : lanes) longest = std::max(longest, double(letters(lane)));
  const double kName = std::clamp(14 + kLetter * longest, kLeastName, kMostName);
  const auto most = std::size_t((kMostName - 14) / kLetter);
  const double bars = double(lanes.size()) * kLane, height = kTop + bars + 2 * kLane + kBottom;
  const double length = std::max(1.0, t.length);
  const Frame f{0, length, 0, 1, kName, kWidth - kRight, kTop, kTop + bars + 2 * kLane};

  std::string out = head("timeline", tr("Steps and errors over time"),
                         tr("{} steps completed and {} errors in {}. The tables list each with its time.",
                            t.bars.size(), t.errors.size(), minutes(t.length)),
                         kWidth, height);
  for (const double v : ticks(0, length, 10, true)) {
    out += line(f.x(v), f.top, f.x(v), f.bottom, "grid");
    out += text(f.x(v), f.bottom + 16, "tick", "middle", minutes(v));
  }
  out += text((f.left + f.right) / 2, height - 6, "label", "middle", tr("Time since the start [min:s]"));
  for (std::size_t i = 0; i < lanes.size(); ++i)
    out += text(kName - 8, kTop + (double(i) + 0.65) * kLane, "tick", "end", first_letters(lanes[i], most));
  out += text(kName - 8, kTop + bars + 0.65 * kLane, "tick", "end", tr("Events"));
  out += text(kName - 8, kTop + bars + 1.65 * kLane, "tick", "end", tr("Errors")) + "\n";
  if (t.clock_from > 0 && t.clock_from < length)
    out += line(f.x(t.clock_from), f.top, f.x(t.clock_from), f.bottom, "clock");
  std::map<std::string, int> shade;
  for (const TimelineBar& b : t.bars) {
    const double y = kTop + double(std::find(lanes.begin(), lanes.end(), b.lane) - lanes.begin()) * kLane;
    const double wide = std::max(1.0, f.x(b.to) - f.x(b.from));
    out += fmt::format(
        "<rect class=\"bar b{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{}\"><title>{} ({} to {})"
        "</title></rect>",
        shade[b.lane]++ % 2, f.x(b.from), y + 3, wide, kLane - 6, escaped(b.name), minutes(b.from), minutes(b.to));
    if (wide > 7.0 * double(letters(b.name))) out += text(f.x(b.from) + 4, y + 0.65 * kLane, "in-bar", "start", b.name);
    out += "\n";
  }
  for (const PlotMark& m : t.events) out += mark(f.x(std::clamp(m.x, 0.0, length)), kTop + bars + 8, m);
  for (const PlotMark& m : t.errors) out += mark(f.x(std::clamp(m.x, 0.0, length)), kTop + bars + kLane + 6, m);
  return out + "</svg>\n";
}

std::string svg(const Projection& p) {
  constexpr double kSide = 250, kEdge = 22;
  const double wide = std::max({p.high[0] - p.low[0], p.high[1] - p.low[1], 1.0});
  const double scale = (kSide - 2 * kEdge) / wide;
  const double middle[2] = {(p.low[0] + p.high[0]) / 2, (p.low[1] + p.high[1]) / 2};
  const Frame f{middle[0] - wide / 2,
                middle[0] + wide / 2,
                middle[1] - wide / 2,
                middle[1] + wide / 2,
                kEdge,
                kSide - kEdge,
                kEdge,
                kSide - kEdge};
  std::string out = head(p.id, p.title, p.description, kSide, kSide);
  out +=
      fmt::format("<rect class=\"frame\" x=\"{0}\" y=\"{0}\" width=\"{1}\" height=\"{1}\"/>", kEdge, kSide - 2 * kEdge);
  for (const Series& s : p.paths) out += path(s, f);
  out += text(kSide - kEdge, kSide - 7, "tick", "end", p.right + " →");
  out += text(kEdge, 15, "tick", "start", "↑ " + p.up);
  const double bar = tick_step(wide, 4);
  out += line(kEdge + 6, kSide - kEdge - 6, kEdge + 6 + bar * scale, kSide - kEdge - 6, "axis");
  out += text(kEdge + 8, kSide - kEdge - 10, "tick", "start", number(bar) + " mm");
  return out + "</svg>\n";
}

}  // namespace trocar::reports
