#include "cad_file.hpp"

#include <string>

#include <BRepBuilderAPI_Sewing.hxx>
#include <IGESControl_Reader.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp_Explorer.hxx>
#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>

namespace trocar::cad {
namespace {

constexpr double kSewn = 0.01;  // [mm] edges that lie so near to each other are one

[[noreturn]] void refuse(const std::filesystem::path& file, std::string message) {
  throw core::BadInput({{{file.generic_string(), 0, 0}, std::move(message)}});
}

bool ends_in(std::string name, std::initializer_list<const char*> endings) {
  for (char& c : name)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  for (const char* e : endings)
    if (name == e) return true;
  return false;
}

template <class Reader>
TopoDS_Shape read(const std::filesystem::path& file, const char* what) {
  Reader reader;
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) refuse(file, tr("expected a whole {} file", what));
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  if (shape.IsNull()) refuse(file, tr("expected shapes in the {} file, got none", what));
  return shape;
}

}  // namespace

std::vector<TopoDS_Shape> parts_of(const std::filesystem::path& file) {
  Message::DefaultMessenger()->ChangePrinters().Clear();  // its readers tell their progress on standard output
  const std::string ending = file.extension().string();
  TopoDS_Shape all;
  if (ends_in(ending, {".step", ".stp"}))
    all = read<STEPControl_Reader>(file, "STEP");
  else if (ends_in(ending, {".iges", ".igs"}))
    all = read<IGESControl_Reader>(file, "IGES");
  else
    refuse(file, "expected a file's name to end in .step, .stp, .iges or .igs");

  std::vector<TopoDS_Shape> out;
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
  return out;
}

}  // namespace trocar::cad
