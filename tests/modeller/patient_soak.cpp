// The patient of the data folder: organs of the label map, compiled, grasped and cut.
#include <trocar/modeller/script/session.hpp>

#include "workplace.hpp"

namespace trocar::modeller {
namespace {

fs::path shared_scans() {
  const fs::path folder = "../shared/data/volumes/totalsegmentator";
  return fs::exists(folder) ? folder : fs::path();
}

void open_patient(const fs::path& folder, Session& session) {
  for (const auto& [step, file] :
       {std::pair{"scan", "example_ct_dicom_raw"}, std::pair{"labels", "example_seg_dicom.nii.gz"}})
    run_step(json(std::string("{\"do\": \"") + step + "\", \"file\": \"" + (folder / file).generic_string() + "\"}"),
             "script", session);
}

TEST(PatientScan, ALiverAndASpleenComeOutOfACT) {
  const fs::path folder = shared_scans();
  if (folder.empty()) GTEST_SKIP() << "no ../shared/data here";
  const Workplace place;
  Session session;
  const auto step = [&](const std::string& text) { run_step(json(text), "script", session); };
  open_patient(folder, session);
  EXPECT_EQ(session.said()[0]["spacing_mm"][2].get<double>(), 2);
  step(R"({"do": "name_segment", "segment": "5", "to": "liver"})");
  step(R"({"do": "name_segment", "segment": "1", "to": "spleen"})");
  step(R"({"do": "measure", "segment": "liver", "mean_from": 88.8, "mean_to": 89.8})");
  step(R"({"do": "measure", "segment": "spleen", "mean_from": 79.1, "mean_to": 80.1})");
  step("{\"do\": \"new\", \"file\": \"" + (place / "scene.json").generic_string() + "\"}");
  for (const char* organ : {"liver", "spleen"}) {
    step(std::string("{\"do\": \"islands\", \"segment\": \"") + organ + "\"}");
    step(std::string("{\"do\": \"organ_from\", \"segment\": \"") + organ + "\", \"name\": \"" + organ +
         "\", \"tissue\": \"liver\", \"cuttable\": true, \"centre_mm\": [" + (organ[0] == 'l' ? "-40" : "75") +
         ", -160, -120]}");
    const Json& made = session.said().back();
    EXPECT_NEAR(made["mL"].get<double>() / made["mL_of_segment"].get<double>(), 1, 0.02) << organ;
  }
  step(R"({"do": "check", "seconds": 0})");
  const double wanted[] = {session.said()[5]["mL"].get<double>(), session.said()[7]["mL"].get<double>()};
  int number = 0;
  for (const Json& body : session.said().back()["check"]) {
    EXPECT_NEAR(body["volume_mL"].get<double>() / wanted[number++], 1, 0.02) << body["name"];
    EXPECT_LE(body["substeps"].get<int>(), 12) << body["name"];
    EXPECT_GT(body["volume_mL"].get<double>(), 10) << body["name"];
  }
}

TEST(PatientScan, ThePatientsSpleenIsGraspedAndCut) {
  const fs::path folder = shared_scans();
  if (folder.empty()) GTEST_SKIP() << "no ../shared/data here";
  const Workplace place;
  Session session;
  const auto step = [&](const std::string& text) { run_step(json(text), "script", session); };
  open_patient(folder, session);
  step("{\"do\": \"new\", \"file\": \"" + (place / "scene.json").generic_string() + "\"}");
  step(R"({"do": "islands", "segment": "1"})");
  step(R"({"do": "organ_from", "segment": "1", "name": "spleen", "tissue": "liver", "cuttable": true,
           "centre_mm": [0, -160, -150]})");
  step(R"({"do": "hold", "of": "spleen", "centre_mm": [0, -160, -175], "radius_mm": 30})");
  step(R"({"do": "take", "at_mm": [5, -150, -100], "of": "spleen"})");
  step(R"({"do": "pull", "by_mm": [0, 0, 6]})");
  EXPECT_TRUE(session.said().back()["holds"].get<bool>());
  EXPECT_GT(session.said().back()["pull_N"].get<double>(), 0.1);
  step(R"({"do": "let_go"})");
  for (const char* at : {"20, -142, -110", "25, -150, -95", "30, -160, -95"})
    step(std::string(R"({"do": "use", "instrument": "scissors", "at_mm": [)") + at + "]}");
  EXPECT_EQ(session.said().back()["cut"], Json::array({"spleen"}));
}

}  // namespace
}  // namespace trocar::modeller
