#pragma once

#include "arguments.hpp"
#include <cattaneo/design/sensitivity.hpp>
#include <memory>
#include <optional>

// The part of the derivatives that design.cpp needs.

namespace cattaneo::python
{

/// A trace with its problem, and the data of the problem that may have changed since.
struct Trace
{
   Trace(const ReducedProblem &of, MarchTrace states)
      : problem(nb::find(of)), trace(std::move(states)), friction(of.friction), gap(of.gap)
   {
   }

   nb::object problem;
   MarchTrace trace;
   Eigen::VectorXd friction, gap;

   /// InputError if `of` has changed since the march.
   void check(const ReducedProblem &of) const;
};

/// Responses of a problem and a trace that are kept; or those that an objective gets, which are
/// valid until its call ends.
class Asked
{
public:
   Asked(const ReducedProblem &problem, const Trace &trace)
      : problem_(std::make_unique<const ReducedProblem>(problem)), trace_(nb::find(trace)),
        own_(std::make_unique<const Responses>(*problem_, trace.trace)), of_(own_.get())
   {
      trace.check(problem);
   }
   explicit Asked(const Responses &of) : of_(&of) {}

   const Responses &operator*() const
   {
      require(of_ != nullptr,
              "responses: those that an objective is called with end with the call");
      return *of_;
   }
   void end() { of_ = nullptr; }

private:
   std::unique_ptr<const ReducedProblem> problem_;
   nb::object trace_;
   std::unique_ptr<const Responses> own_;
   const Responses *of_;
};

void bind_sensitivity(nb::module_ &m);
/// Derivatives of results at edges of contact, and of limits.
void bind_readout_gradients(nb::module_ &m);

} // namespace cattaneo::python
