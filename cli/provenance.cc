#include "sidestep/cli/provenance.h"

#include "sidestep/cli/build_id.h"
#include "sidestep/cli/versions.h"

namespace sidestep::cli {

bench::RunIdentity Identify(const scenarios::Scenario& scenario, const DataPaths& paths) {
  return bench::IdentifyRun(scenario, paths.models, BuildId());
}

void AddProvenance(const bench::RunIdentity& identity, record::Recording& recording) {
  recording.header["identity.run"] = bench::RunId(identity);
  recording.header["identity.scenario"] = identity.scenario;
  recording.header["identity.models"] = identity.models;
  for (const auto& [part, version] : Versions()) recording.header["version." + part] = version;
}

}  // namespace sidestep::cli
