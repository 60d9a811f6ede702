#include "accrete/contract.h"

#include <atomic>

namespace accrete {
namespace {

// A trap instead of abort(): the core has no such symbol, and a debugger stops at the very place.
void trap(const ContractViolation& /*violation*/) { __builtin_trap(); }

std::atomic<ContractHandler> g_handler{trap};

}  // namespace

ContractHandler set_contract_handler(ContractHandler handler) {
  return g_handler.exchange(handler != nullptr ? handler : trap);
}

void report_contract_violation(const ContractViolation& violation) { g_handler.load()(violation); }

}  // namespace accrete
