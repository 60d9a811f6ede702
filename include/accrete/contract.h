// Preconditions. A broken one is a bug of the caller: the handler is told and by default stops the program, because
// going on would compute nonsense. Tests and embedded users install their own handler.
#pragma once

namespace accrete {

struct ContractViolation {  // what was required, and where
  const char* condition;
  const char* file;
  int line;
};

using ContractHandler = void (*)(const ContractViolation&);

// Installs `handler` (null: the default, which traps) and returns the previous one. The handler may return: then the
// call goes on as its documentation says for a broken precondition, or with undefined results. Not thread-safe.
ContractHandler set_contract_handler(ContractHandler handler);

// Called by ACCRETE_EXPECTS only.
void report_contract_violation(const ContractViolation& violation);

}  // namespace accrete

#define ACCRETE_EXPECTS(condition)                                                            \
  do {                                                                                        \
    if (!(condition)) ::accrete::report_contract_violation({#condition, __FILE__, __LINE__}); \
  } while (false)
