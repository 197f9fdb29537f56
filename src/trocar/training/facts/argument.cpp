#include <trocar/sim/model/bodies.hpp>
#include <trocar/training/facts/argument.hpp>

namespace trocar::training {
namespace {

template <class List>
void add_names(const List& list, std::vector<std::string>& names) {
  for (const auto& item : list) names.push_back(item.name);
}

bool find_body(const sim::Model& model, const std::string& name, std::int32_t& index, std::vector<std::string>& known) {
  const BodyId body = sim::body_of(model, name);
  index = body.code();
  if (body.exists()) return true;
  for (const auto& fold : model.drawn_folds)
    if (fold.name == name) return true;  // drawn only: nobody can hold it
  sim::visit_bodies(model, [&](auto ref) { known.push_back(model_of(model, ref).name); });
  return false;
}

}  // namespace

bool names_something(ArgumentKind kind) {
  return kind != ArgumentKind::number && kind != ArgumentKind::range && kind != ArgumentKind::word &&
         kind != ArgumentKind::landmark;
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
    case ArgumentKind::marks:
      return "mark of the scene";
    case ArgumentKind::vessel:
      return "vessel of the scene";
    case ArgumentKind::word:
      return "word";
    case ArgumentKind::landmark:
      return "landmark";
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
  } else if (kind == ArgumentKind::mark || kind == ArgumentKind::marks) {
    index = model.target_index(name);
    add_names(model.targets, known);
  } else {
    index = model.vessel_index(name);
    add_names(model.vessels.list, known);
  }
  return index >= 0;
}

}  // namespace trocar::training
