#include "vacuum_gripper_sim/core/elimination_order.h"

#ifdef VACUUM_GRIPPER_METIS

#include <metis.h>

#include <csignal>

namespace vacuum_gripper_sim {
namespace {

/** While it works METIS 5.1 handles SIGTERM and SIGABRT itself, and puts back no more than plain
 handlers without flags. This keeps the host's, and lets a SIGTERM to this thread wait for them. */
class HostSignals {
 public:
  HostSignals() {
    sigset_t terminate;
    sigemptyset(&terminate);
    sigaddset(&terminate, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &terminate, &mask_);
    sigaction(SIGTERM, nullptr, &on_terminate_);
    sigaction(SIGABRT, nullptr, &on_abort_);
  }
  ~HostSignals() {
    sigaction(SIGTERM, &on_terminate_, nullptr);
    sigaction(SIGABRT, &on_abort_, nullptr);
    pthread_sigmask(SIG_SETMASK, &mask_, nullptr);
  }
  HostSignals(const HostSignals&) = delete;
  HostSignals& operator=(const HostSignals&) = delete;

 private:
  sigset_t mask_{};
  struct sigaction on_terminate_ = {};
  struct sigaction on_abort_ = {};
};

}  // namespace

std::vector<int> NestedDissectionOrder(const NodeGraph& graph, int seed) {
  std::vector<idx_t> first{0}, neighbours;
  for (const std::vector<int>& of_node : graph) {
    neighbours.insert(neighbours.end(), of_node.begin(), of_node.end());
    first.push_back(static_cast<idx_t>(neighbours.size()));
  }
  if (neighbours.empty()) return {};  // nothing to dissect, and no pointer for METIS
  auto size = static_cast<idx_t>(graph.size());
  std::vector<idx_t> nodes(graph.size()), positions(graph.size());
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = static_cast<idx_t>(seed);
  const HostSignals host_signals;
  const int status = METIS_NodeND(&size, first.data(), neighbours.data(), nullptr, options,
                                  nodes.data(), positions.data());
  if (status != METIS_OK) return {};
  return {nodes.begin(), nodes.end()};
}

}  // namespace vacuum_gripper_sim

#else

namespace vacuum_gripper_sim {

std::vector<int> NestedDissectionOrder(const NodeGraph&, int) { return {}; }

}  // namespace vacuum_gripper_sim

#endif
