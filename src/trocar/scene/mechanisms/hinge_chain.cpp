#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/scene/mechanisms/hinge_chain.hpp>

namespace trocar::scene {
namespace {

using kinematics::Frame;
using kinematics::Mechanism;

constexpr double kBesideAxis = 1e-7;  // [m] what numbers in files leave
constexpr double kAslant = 1e-6;      // [rad]

/// From the tip's body back to the shaft's, turned round; empty where they are not in one line.
std::vector<int> bodies_from_shaft(const Mechanism& m, int shaft, int tip) {
  std::vector<int> out;
  for (int body = tip; body != shaft; body = m.bodies[std::size_t(body)].parent) {
    if (body <= 0) return {};
    out.insert(out.begin(), body);
  }
  return out;
}

/// A hinge where the chain is straight, in the shaft's frame.
struct StraightHinge {
  int coordinate = 0;
  std::string name;
  Vec3d place, axis;
  double step = 0;  ///< along the shaft's z from the hinge before, or the shaft's end [m]
};

/// A row of q = E u + e, all its terms.
struct Row {
  std::vector<double> ratio;  ///< (u)
  int terms = 0, u = -1;      ///< how many are not 0; the one, where it is one

  Row(const Mechanism& m, int q) : ratio(std::size_t(m.u_count()), 0.0) {
    for (int e = m.expand_start[std::size_t(q)]; e < m.expand_start[std::size_t(q) + 1]; ++e) {
      const Mechanism::Entry& entry = m.expand[std::size_t(e)];
      ratio[std::size_t(entry.u)] += entry.ratio;
    }
    for (std::size_t k = 0; k < ratio.size(); ++k)
      if (ratio[k] != 0) ++terms, u = int(k);
  }

  /// This row is so many times the other; 0: it is no multiple.
  double times(const Row& other) const {
    std::size_t most = 0;
    for (std::size_t k = 1; k < ratio.size(); ++k)
      if (std::fabs(other.ratio[k]) > std::fabs(other.ratio[most])) most = k;
    const double factor = ratio[most] / other.ratio[most];
    for (std::size_t k = 0; k < ratio.size(); ++k)
      if (std::fabs(ratio[k] - factor * other.ratio[k]) > 1e-12) return 0;
    return factor;
  }
};

/// Can motors bring the joints to whatever angles: are the rows independent of each other?
bool independent(std::vector<Row> rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<double>& r = rows[i].ratio;
    const auto pivot =
        std::max_element(r.begin(), r.end(), [](double a, double b) { return std::fabs(a) < std::fabs(b); });
    if (pivot == r.end() || std::fabs(*pivot) < 1e-9) return false;
    const std::size_t column = std::size_t(pivot - r.begin());
    for (std::size_t j = i + 1; j < rows.size(); ++j) {
      const double share = rows[j].ratio[column] / r[column];
      for (std::size_t k = 0; k < r.size(); ++k) rows[j].ratio[k] -= share * r[k];
    }
  }
  return true;
}

std::string mm(double metres) { return fmt::format("{:.3g} mm", 1000 * metres); }

class Chain {
 public:
  explicit Chain(const Mechanism& m) : m_m(m) {}

  std::string find(double jaw_length, kinematics::Articulation& out) {
    if (std::string why = lay(); !why.empty()) return why;
    if (std::string why = order(jaw_length, out); !why.empty()) return why;
    return share(out);
  }

 private:
  /// All bodies with their hinges at 0.
  std::string lay() {
    const int link = m_m.link("shaft"), frame = m_m.frame("tip");
    const int shaft = m_m.link_body[std::size_t(link)];
    const kinematics::BodyFrame& tip = m_m.frames[std::size_t(frame)];
    Frame at;
    double step = 0;  // summed piece by piece: lengths stay what the file says
    for (const int body : bodies_from_shaft(m_m, shaft, tip.body)) {
      if (in_loop(body)) return "one whose loops go through its links";
      const kinematics::Body& b = m_m.bodies[std::size_t(body)];
      const Frame& place = m_m.places[std::size_t(body)];
      step += (at.r * place.p).z;
      at = at * place;
      if (b.motion == kinematics::Motion::none) continue;
      const std::string& name = m_m.coordinates[std::size_t(b.coordinate)];
      if (b.motion == kinematics::Motion::slide) return tr("'{}', which slides", name);
      m_hinges.push_back({b.coordinate, name, at.p, at.r * b.axis, step});
      step = 0;
    }
    m_last_step = step + (at.r * tip.local.p).z;
    m_tip = at * tip.local;
    return m_hinges.empty() ? "one without" : "";
  }

  bool in_loop(int body) const {
    return std::any_of(m_m.closures.begin(), m_m.closures.end(),
                       [body](const kinematics::Closure& c) { return c.a.body == body || c.b.body == body; });
  }

  /// Hinges along the shaft's axis, in the frame of the tip.
  std::string order(double jaw_length, kinematics::Articulation& out) {
    const double ahead = m_tip.p.z - m_hinges.front().place.z;
    const double off = std::sqrt(m_tip.p.x * m_tip.p.x + m_tip.p.y * m_tip.p.y);
    if (off > kBesideAxis) return tr("a tip {} beside the shaft's axis", mm(off));
    const Vec3d forwards{0, 0, ahead >= 0 ? 1.0 : -1.0}, x = m_tip.r.column(0);
    if (std::fabs(x.z) > kAslant) return "a tip whose x, where jaws open, is not square to the shaft";
    const Vec3d y = cross(-forwards, x);
    double last = 0;
    for (const StraightHinge& h : m_hinges) {
      const double beside = std::fabs(h.place.x * h.axis.y - h.place.y * h.axis.x), along = h.place.z * forwards.z;
      if (std::fabs(h.axis.z) > kAslant) return tr("'{}', which is not square to the shaft", h.name);
      if (beside > kBesideAxis) return tr("'{}', which is {} beside the shaft's axis", h.name, mm(beside));
      const double about_x = dot(h.axis, x), about_y = dot(h.axis, y);
      if (std::min(std::fabs(about_x), std::fabs(about_y)) > kAslant)
        return tr("'{}', which turns about neither x nor y of the tip", h.name);
      if (along - last < -kBesideAxis) return tr("'{}', which is behind the one before", h.name);
      if (out.hinges == kinematics::kMaxHinges) return tr("more than {} hinges", kinematics::kMaxHinges);
      kinematics::Hinge& made = out.hinge[out.hinges++];
      made.before = std::max(0.0, forwards.z * h.step);
      made.across = std::fabs(about_y) > 0.5 ? 1 : 0;
      made.share = (made.across ? about_y : about_x) > 0 ? 1 : -1;
      last = along;
    }
    out.after = forwards.z * m_last_step - jaw_length;
    if (out.after < -kBesideAxis)
      return tr("a tip {} after the last hinge, nearer than jaws of {}", mm(out.after + jaw_length), mm(jaw_length));
    out.after = std::max(0.0, out.after);
    if (out.links() > kinematics::kMaxLinks)
      return tr("{} straight pieces, more than {}", out.links(), kinematics::kMaxLinks);
    return "";
  }

  /// Which hinges turn together, and how far.
  std::string share(kinematics::Articulation& out) {
    std::vector<Row> rows;      // of each joint's first hinge
    std::vector<double> leads;  // that hinge's angle per joint's
    for (std::size_t i = 0; i < m_hinges.size(); ++i) {
      const auto q = std::size_t(m_hinges[i].coordinate);
      const Row row(m_m, int(q));
      if (row.terms == 0 || m_m.offset[q] != 0) return tr("'{}', which cannot be 0", m_hinges[i].name);
      std::size_t joint = 0;
      double factor = 0;
      while (joint < rows.size() && (factor = row.times(rows[joint])) == 0) ++joint;
      if (joint == rows.size()) {
        if (joint == std::size_t(kinematics::kMaxJoints)) return tr("more than {} joints", joint);
        const bool one = row.terms == 1;
        const std::size_t limits = one ? std::size_t(m_m.independent[std::size_t(row.u)]) : q;
        if (!std::isfinite(m_m.low[limits]) || !std::isfinite(m_m.high[limits]))
          return tr("'{}' without limits", m_m.coordinates[limits]);
        out.low[joint] = m_m.low[limits], out.high[joint] = m_m.high[limits];
        leads.push_back(one ? row.ratio[std::size_t(row.u)] : 1.0);
        rows.push_back(row);
        factor = 1;
      }
      out.hinge[i].joint = std::int32_t(joint);
      out.hinge[i].share *= factor * leads[joint];
    }
    out.joints = std::int32_t(rows.size());
    for (std::size_t joint = 0; joint < rows.size(); ++joint) lead_itself(joint, leads[joint], out);
    return independent(std::move(rows)) ? "" : "joints that motors cannot turn each by itself";
  }

  /// The angle of a joint that is one hinge is that hinge's, and not that of the motor which turns it.
  /// @param ratio  of the hinge's angle to the motor's
  void lead_itself(std::size_t joint, double ratio, kinematics::Articulation& out) const {
    int only = -1;
    for (int i = 0; i < out.hinges; ++i) {
      if (out.hinge[i].joint != std::int32_t(joint)) continue;
      if (only >= 0) return;
      only = i;
    }
    const auto q = std::size_t(m_hinges[std::size_t(only)].coordinate);
    out.hinge[only].share /= ratio;
    const double ends[2] = {ratio * out.low[joint], ratio * out.high[joint]};
    out.low[joint] = std::max(std::min(ends[0], ends[1]), m_m.low[q]);
    out.high[joint] = std::min(std::max(ends[0], ends[1]), m_m.high[q]);
  }

  const Mechanism& m_m;
  std::vector<StraightHinge> m_hinges;
  Frame m_tip;
  double m_last_step = 0;  ///< from the last hinge to the tip
};

}  // namespace

std::string take_hinges(const Mechanism& m, double jaw_length, kinematics::Articulation& out) {
  if (m.link("shaft") < 0) return tr("links without a 'shaft' ({})", fmt::join(m.links, ", "));
  if (m.frame("tip") < 0) return tr("frames without a 'tip' ({})", fmt::join(m.frame_names, ", "));
  kinematics::Articulation found;
  std::string why = Chain(m).find(jaw_length, found);
  if (why.empty()) out = found;
  return why;
}

}  // namespace trocar::scene
