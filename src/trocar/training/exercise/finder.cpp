#include <trocar/training/exercise/finder.hpp>

namespace trocar::training {
namespace {

template <class List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  for (const auto& item : list) names.push_back(item.name);
  return names;
}

template <class List>
int index_of(const List& list, const std::string& name) {
  for (size_t i = 0; i < list.size(); ++i)
    if (list[i].name == name) return int(i);
  return -1;
}

}  // namespace

int Finder::strand(const std::string& name, const core::Location& at) const {
  const int i = model.strand_index(name);
  if (i < 0) faults.push_back({at, scene::unknown_name("strand of the scene", name, names_of(model.strands))});
  return i;
}

std::vector<std::string> Finder::organ_names() const {
  std::vector<std::string> names;
  for (int i = 0; i < model.organs(); ++i) names.push_back(model.organ_name(i));
  return names;
}

int Finder::organ(const std::string& name, const core::Location& at) const {
  const int i = model.organ_index(name);
  if (i < 0) faults.push_back({at, scene::unknown_name("organ of the scene", name, organ_names())});
  return i;
}

std::int32_t Finder::body(const Named& named) const {
  const int s = model.strand_index(named.name);
  if (s >= 0) return s;
  const int o = model.organ_index(named.name);
  if (o >= 0) return interactions::kSolidBase + o;
  const int fold = model.membrane_index(named.name);
  if (fold >= 0) return interactions::kMembraneBase + fold;
  if (index_of(model.drawn_folds, named.name) < 0) {
    std::vector<std::string> known = names_of(model.strands);
    for (const std::string& n : organ_names()) known.push_back(n);
    faults.push_back({named.at, scene::unknown_name("body of the scene", named.name, known)});
  }
  return -1;
}

int Finder::fold(const std::string& name, const core::Location& at) const {
  const int i = model.membrane_index(name);
  if (i < 0 && index_of(model.drawn_folds, name) < 0) {
    std::vector<std::string> known = names_of(model.membranes);
    for (const std::string& n : names_of(model.drawn_folds)) known.push_back(n);
    faults.push_back({at, scene::unknown_name("fold of the scene", name, known)});
  }
  return i;
}

void Finder::instrument(const std::string& name, const core::Location& at, interactions::ToolKind kind,
                        const char* what) const {
  std::vector<std::string> known;
  for (const sim::HandModel& hand : model.hands)
    for (const interactions::ToolModel& tool : hand.rack) {
      if (tool.name != name) {
        known.push_back(tool.name);
        continue;
      }
      if (tool.kind != kind)
        faults.push_back(
            {at, std::string("expected ") + what + ", got \"" + name + "\", which is another kind of tool"});
      return;
    }
  faults.push_back({at, scene::unknown_name("instrument of the scene", name, known)});
}

double Finder::landmark(int strand, const char* name, bool end, const core::Location& at) const {
  if (strand < 0) return 0;
  for (const sim::LandmarkModel& l : model.strands[size_t(strand)].landmarks)
    if (l.name == name) return end ? l.to : l.from;
  faults.push_back({at, std::string("expected a tube with the landmark \"") + name + "\", got none"});
  return 0;
}

}  // namespace trocar::training
