/// Contracts: checked in every build that defines CLEAVE_CHECKED (presets dev, audit, asan), free otherwise.
///
/// `expects` guards an input, `ensures` a result, `asserts` something in between. What a user can get wrong is
/// never a contract: throw an error of core/error.h instead.
#pragma once

namespace core
{
/// Print the broken contract with its place and abort.
[[noreturn]] void contract_broken(const char* kind, const char* condition, const char* file, int line);
} // namespace core

#ifdef CLEAVE_CHECKED
#define CLEAVE_CONTRACT(kind, condition)                                                                               \
    (static_cast<bool>(condition) ? static_cast<void>(0) : core::contract_broken(kind, #condition, __FILE__, __LINE__))
#else
#define CLEAVE_CONTRACT(kind, condition) static_cast<void>(0)
#endif

#define CLEAVE_EXPECTS(condition) CLEAVE_CONTRACT("expects", condition)
#define CLEAVE_ENSURES(condition) CLEAVE_CONTRACT("ensures", condition)
#define CLEAVE_ASSERTS(condition) CLEAVE_CONTRACT("asserts", condition)
