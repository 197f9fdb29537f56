// A mechanism on a desk: its parameters are turned and its drives moved by hand, one sees at once how it stands, where
// a frame goes, and how near its links come to each other over the whole motion. Everything can be taken back.
//
//   DesignDesk desk(read_mechanism(file));
//   desk.turn(dial, 0.012);  desk.keep();      // keep(): what has been changed since is one step of undo
//   desk.lead(0, 0.3);
//   desk.pose();  desk.words();  desk.clearance()
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <trocar/kinematics/chains/description.hpp>
#include <trocar/kinematics/loops/close.hpp>
#include <trocar/studies/clearance.hpp>
#include <trocar/studies/link_pairs.hpp>

namespace trocar::studies {

class DesignDesk {
 public:
  static constexpr int kPathSteps = 60;

  /// @throws std::invalid_argument where it cannot be built
  explicit DesignDesk(const kinematics::MechanismDescription& description);

  const kinematics::Mechanism& mechanism() const { return m_now; }
  const kinematics::Pose& pose() const { return m_work.pose; }
  /// Do the loops close with these dimensions, there?
  bool closed() const { return m_report.closed(); }
  /// "closed to 3.1e-14 m; ..."
  std::string words() const { return kinematics::words(m_now, m_report); }

  /// A parameter with a name, and between what it can be turned: as its file says, else about its value there.
  struct Dial {
    int parameter = 0;
    double low = 0, high = 0;  ///< [m, rad, 1]
    bool bounded = false;      ///< the file says so
  };
  const std::vector<Dial>& dials() const { return m_dials; }
  double value(const Dial& dial) const { return m_values[std::size_t(dial.parameter)]; }
  double value_in_file(const Dial& dial) const { return m_start.parameter_values[std::size_t(dial.parameter)]; }
  /// Bounded by the dial; what follows is made again.
  void turn(const Dial& dial, double value);

  /// What is moved: a drive, or, where nothing is driven and no loop closed, a coordinate with limits.
  struct Lead {
    std::string name;
    int independent = 0;
    double at_0 = 0, at_1 = 0;  ///< of the coordinate, now
  };
  const std::vector<Lead>& leads() const { return m_leads; }
  double handle(std::size_t lead) const { return m_handles[lead]; }
  /// @param handle  0 to 1
  void lead(std::size_t lead, double handle);

  bool changed() const;  ///< from the file
  void keep();           ///< what has been turned since the last time is one step
  bool can_undo() const { return !m_undone_to.empty(); }
  bool can_redo() const { return !m_redone_to.empty(); }
  void undo();
  void redo();
  void reset();                                                   ///< as in the file; can be taken back
  const std::vector<double>& values() const { return m_values; }  ///< (parameters) [m, rad, 1]
  void put(std::span<const double> values);                       ///< all at once, a step of undo

  /// Over the whole motion, with these dimensions; nothing: it does not close at its start, or nothing leads it.
  const std::optional<ClearanceReport>& clearance() const;
  /// How far those two links are apart as it stands; below 0: in each other, neighbours deeper than in the file. [m]
  double gap_now(const PairClearance& pair) const;
  /// Where a frame goes while the first lead goes its way, the others being where they are. [m]
  std::vector<Vec3d> path(int frame) const;

 private:
  void stand();
  void find_leads();
  void set_leads(std::span<const double> handles, std::span<double> u) const;

  kinematics::Mechanism m_start, m_now;
  std::vector<Dial> m_dials;
  std::vector<Lead> m_leads;
  std::vector<double> m_values, m_kept, m_handles;
  std::vector<double> m_u, m_good;  ///< as it stands; the last that closed
  kinematics::LoopWork m_work;
  LinkPairs m_links;
  std::vector<double> m_drawn;  ///< gaps of neighbours as in the file
  kinematics::LoopReport m_report;
  std::vector<std::vector<double>> m_undone_to, m_redone_to;  ///< values
  mutable std::optional<ClearanceReport> m_clearance;
  mutable bool m_looked = false;  ///< the clearance is that of these values
};

}  // namespace trocar::studies
