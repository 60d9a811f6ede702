#include "accrete/contract.h"

#include <gtest/gtest.h>

#include <string>

namespace accrete {
namespace {

std::string g_condition;
int g_line = 0;

void remember(const ContractViolation& v) {
  g_condition = v.condition;
  g_line = v.line;
}

TEST(Contract, TellsTheInstalledHandlerOnceAndOnlyWhenBroken) {
  const ContractHandler previous = set_contract_handler(remember);
  ACCRETE_EXPECTS(1 + 1 == 2);
  EXPECT_EQ(g_condition, "");
  const int line = __LINE__ + 1;
  ACCRETE_EXPECTS(1 + 1 == 3);
  EXPECT_EQ(g_condition, "1 + 1 == 3");
  EXPECT_EQ(g_line, line);
  EXPECT_EQ(set_contract_handler(previous), remember);
}

TEST(ContractDeathTest, TheDefaultStopsTheProgram) {
  set_contract_handler(nullptr);
  EXPECT_DEATH(ACCRETE_EXPECTS(false), "");
}

}  // namespace
}  // namespace accrete
