#include "cad_file.hpp"

#include <string>

#include <BRepBuilderAPI_Sewing.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_BasicEditor.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Reader.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>

namespace trocar::cad {
namespace {

constexpr double kSewn = 0.01;  // [mm] edges that lie so near to each other are one

[[noreturn]] void refuse(const std::filesystem::path& file, std::string message) {
  throw core::BadInput({{{file.generic_string(), 0, 0}, std::move(message)}});
}

struct NamedUnit {
  const char* name;
  double mm;
};
constexpr NamedUnit kStepUnits[] = {{"millimetre", 1},  {"centimetre", 10}, {"decimetre", 100}, {"metre", 1000},
                                    {"inch", 25.4},     {"foot", 304.8},    {"mil", 0.0254},    {"micrometre", 1e-3},
                                    {"kilometre", 1e6}, {"millimeter", 1},  {"meter", 1000}};

double unit_mm(STEPControl_Reader& reader) {
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  double found = 0;
  for (const TCollection_AsciiString& name : lengths)
    for (const NamedUnit& unit : kStepUnits)
      if (core::in_small_letters(name.ToCString()) == unit.name) {
        if (found > 0 && found != unit.mm) return 1;
        found = unit.mm;
      }
  return found > 0 ? found : 1;
}

double unit_mm(IGESControl_Reader& reader) {
  const double mm = IGESData_BasicEditor::UnitFlagValue(reader.IGESModel()->GlobalSection().UnitFlag());
  return mm > 0 ? mm : 1;
}

template <class Reader>
TopoDS_Shape read(const std::filesystem::path& file, const char* what, double& mm) {
  Reader reader;
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) refuse(file, tr("expected a whole {} file", what));
  mm = unit_mm(reader);
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  if (shape.IsNull()) refuse(file, tr("expected shapes in the {} file, got none", what));
  return shape;
}

}  // namespace

CadFile read_cad(const std::filesystem::path& file) {
  Message::DefaultMessenger()->ChangePrinters().Clear();  // its readers tell their progress on standard output
  const std::string ending = core::in_small_letters(file.extension().string());
  CadFile made;
  TopoDS_Shape all;
  if (ending == ".step" || ending == ".stp")
    all = read<STEPControl_Reader>(file, "STEP", made.unit_mm);
  else if (ending == ".iges" || ending == ".igs")
    all = read<IGESControl_Reader>(file, "IGES", made.unit_mm);
  else
    refuse(file, "expected a file's name to end in .step, .stp, .iges or .igs");

  std::vector<TopoDS_Shape>& out = made.parts;
  for (TopExp_Explorer e(all, TopAbs_SOLID); e.More(); e.Next()) out.push_back(e.Current());
  BRepBuilderAPI_Sewing sewing(kSewn);
  int loose = 0;
  for (TopExp_Explorer e(all, TopAbs_FACE, TopAbs_SOLID); e.More(); e.Next(), ++loose) sewing.Add(e.Current());
  if (loose > 0) {
    sewing.Perform();
    const TopoDS_Shape sewn = sewing.SewedShape();
    for (TopExp_Explorer e(sewn, TopAbs_SHELL); e.More(); e.Next()) out.push_back(e.Current());
    for (TopExp_Explorer e(sewn, TopAbs_FACE, TopAbs_SHELL); e.More(); e.Next()) out.push_back(e.Current());
  }
  if (out.empty()) refuse(file, "expected solids or faces, got a file without any");
  return made;
}

}  // namespace trocar::cad
