#pragma once

#include "common/study.hpp"

namespace miniapp
{

/// --strength and --strength-backward: a law of friction other than Coulomb's, the same at all
/// nodes.
class StrengthOptions
{
public:
   explicit StrengthOptions(Study &study);
   /// To be called after parse(). InputError if they contradict each other or --friction.
   void check() const;
   bool given() const { return !forward.empty(); }
   /// Gives the problem the law. InputError if the law is not valid.
   void set(cattaneo::ReducedProblem &problem) const;

private:
   Study &study;
   std::vector<double> forward, backward; ///< pressure and strength of each point in turn
};

} // namespace miniapp
