#include "cli/doctor/doctor_report.h"

#include <fmt/format.h>

namespace accrete::cli {
namespace {

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::kOk:
      return "ok";
    case Verdict::kFault:
      return "WRONG";
    case Verdict::kNotChecked:
      return "not checked";
  }
  return "unknown";
}

}  // namespace

std::string to_text(const Diagnosis& diagnosis) {
  std::size_t names = 5, measured = 8, limits = 5;
  for (const DoctorCheck& c : diagnosis.checks) {
    names = std::max(names, c.name.size());
    measured = std::max(measured, c.measured.size());
    limits = std::max(limits, c.limit.size());
  }
  std::string out;
  const auto row = [&](const std::string& name, const std::string& value, const std::string& limit, const char* word) {
    out += fmt::format("{:{}}  {:{}}  {:{}}  {}\n", name, names, value, measured, limit, limits, word);
  };
  row("check", "measured", "limit", "verdict");
  for (const DoctorCheck& c : diagnosis.checks) row(c.name, c.measured, c.limit, to_string(c.verdict));
  for (const DoctorFinding& f : diagnosis.findings)
    out += fmt::format("\n{} ({})\n  {}\n  What to do: {}\n", f.fault, f.certainty, f.what, f.advice);
  if (diagnosis.sane()) out += "\nNothing is wrong with this rig, as far as could be checked.\n";
  return out;
}

nlohmann::ordered_json to_json(const Diagnosis& diagnosis) {
  nlohmann::ordered_json checks = nlohmann::ordered_json::array(), findings = checks;
  for (const DoctorCheck& c : diagnosis.checks)
    checks.push_back(
        {{"check", c.name}, {"measured", c.measured}, {"limit", c.limit}, {"verdict", to_string(c.verdict)}});
  for (const DoctorFinding& f : diagnosis.findings)
    findings.push_back({{"fault", f.fault}, {"certainty", f.certainty}, {"what", f.what}, {"advice", f.advice}});
  return {{"sane", diagnosis.sane()}, {"findings", findings}, {"checks", checks}};
}

}  // namespace accrete::cli
