#include <trocar/training/facts/argument.hpp>

namespace trocar::training {
namespace {

template <class List>
void add_names(const List& list, std::vector<std::string>& names) {
  for (const auto& item : list) names.push_back(item.name);
}

void add_organs(const sim::Model& model, std::vector<std::string>& names) {
  for (int i = 0; i < model.organs(); ++i) names.push_back(model.organ_name(i));
}

bool find_body(const sim::Model& model, const std::string& name, std::int32_t& index, std::vector<std::string>& known) {
  index = kNoBody;
  if (const int s = model.strand_index(name); s >= 0) {
    index = s;
  } else if (const int o = model.organ_index(name); o >= 0) {
    index = interactions::kSolidBase + o;
  } else if (const int m = model.membrane_index(name); m >= 0) {
    index = interactions::kMembraneBase + m;
  } else {
    for (const auto& fold : model.drawn_folds)
      if (fold.name == name) return true;  // drawn only: nobody can hold it
    add_names(model.strands, known);
    add_organs(model, known);
    add_names(model.membranes, known);
    return false;
  }
  return true;
}

}  // namespace

bool names_something(ArgumentKind kind) {
  return kind != ArgumentKind::number && kind != ArgumentKind::range && kind != ArgumentKind::word;
}

std::string_view noun(ArgumentKind kind) {
  switch (kind) {
    case ArgumentKind::number:
      return "number";
    case ArgumentKind::range:
      return "range";
    case ArgumentKind::hand:
      return "hand of the scene";
    case ArgumentKind::strand:
      return "strand of the scene";
    case ArgumentKind::body:
    case ArgumentKind::bodies:
      return "body of the scene";
    case ArgumentKind::mark:
      return "mark of the scene";
    case ArgumentKind::vessel:
      return "vessel of the scene";
    case ArgumentKind::word:
      return "word";
  }
  return "";
}

bool find_named(const sim::Model& model, ArgumentKind kind, const std::string& name, std::int32_t& index,
                std::vector<std::string>& known) {
  if (kind == ArgumentKind::body || kind == ArgumentKind::bodies) return find_body(model, name, index, known);
  if (kind == ArgumentKind::hand) {
    index = model.hand_index(name);
    add_names(model.hands, known);
  } else if (kind == ArgumentKind::strand) {
    index = model.strand_index(name);
    add_names(model.strands, known);
  } else if (kind == ArgumentKind::mark) {
    index = model.target_index(name);
    add_names(model.targets, known);
  } else {
    index = model.vessel_index(name);
    add_names(model.vessels.list, known);
  }
  return index >= 0;
}

}  // namespace trocar::training
