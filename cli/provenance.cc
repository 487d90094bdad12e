#include "sidestep/cli/provenance.h"

#include "sidestep/cli/build_id.h"
#include "sidestep/cli/versions.h"

namespace sidestep::cli {
namespace {

const std::string kVersionKey = "version.";  // begins the keys of the versions in a header

}  // namespace

bench::RunIdentity Identify(const scenarios::Scenario& scenario, const DataPaths& paths) {
  return bench::IdentifyRun(scenario, paths.all_models(), BuildId());
}

std::map<std::string, std::string> Provenance(const bench::RunIdentity& identity) {
  std::map<std::string, std::string> facts = {{"identity.run", bench::RunId(identity)},
                                              {"identity.scenario", identity.scenario},
                                              {"identity.models", identity.models}};
  for (const auto& [part, version] : Versions()) facts[kVersionKey + part] = version;
  return facts;
}

bench::RunIdentity IdentityIn(const std::map<std::string, std::string>& header) {
  return {header.at("identity.scenario"), header.at("identity.models"),
          header.at(kVersionKey + "build_id"), ""};
}

std::map<std::string, std::string> VersionsIn(const std::map<std::string, std::string>& header) {
  std::map<std::string, std::string> versions;
  for (const auto& [key, value] : header) {
    if (key.starts_with(kVersionKey)) versions[key.substr(kVersionKey.size())] = value;
  }
  return versions;
}

void AddProvenance(const bench::RunIdentity& identity, record::Recording& recording) {
  for (const auto& [key, value] : Provenance(identity)) recording.header[key] = value;
}

}  // namespace sidestep::cli
