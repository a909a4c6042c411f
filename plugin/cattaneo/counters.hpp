#pragma once

namespace cattaneo
{

/// How often each expensive operation was done. Every report has one, which shows that
/// operations that a scene does not need were not done. Tests assert these numbers.
struct Counters
{
   long assemblies = 0;         ///< elastic operators assembled
   long factorisations = 0;     ///< sparse factorisations
   long back_substitutions = 0; ///< right-hand sides solved (sparse factor, or iterations)
   long krylov_iterations = 0;  ///< of all iterative solves together
   long field_recoveries = 0;   ///< interior displacement fields recovered
   long unions = 0;             ///< pairs of condensed bodies joined
   /// Tangential unknowns of the friction problem (0 if frictionless); of several problems the
   /// largest number. It is a size, not a count, so that it is not summed.
   long tangential_unknowns = 0;
   long increments = 0;           ///< accepted increments of a march
   long rejected_increments = 0;  ///< increments that failed and were cut
   long sweeps = 0;               ///< Gauss–Seidel sweeps over all contact nodes
   long newton_steps = 0;         ///< active-set (semismooth Newton) steps
   long dense_factorisations = 0; ///< dense factorisations by the friction solver
   long dense_updates = 0;        ///< unknowns bordered to a dense factor instead
   long pivots = 0;               ///< node states exchanged one by one, along a path
   long near_contacts = 0;        ///< problems made of only the nodes that may soon touch
   long limit_solves = 0;         ///< shakedown limit programmes solved

   /// Calls visit(name, value&) for every counter, in the order above.
   template <class Self, class Visitor>
   static void for_each(Self &self, Visitor visit)
   {
      visit("assemblies", self.assemblies);
      visit("factorisations", self.factorisations);
      visit("back_substitutions", self.back_substitutions);
      visit("krylov_iterations", self.krylov_iterations);
      visit("field_recoveries", self.field_recoveries);
      visit("unions", self.unions);
      visit("tangential_unknowns", self.tangential_unknowns);
      visit("increments", self.increments);
      visit("rejected_increments", self.rejected_increments);
      visit("sweeps", self.sweeps);
      visit("newton_steps", self.newton_steps);
      visit("dense_factorisations", self.dense_factorisations);
      visit("dense_updates", self.dense_updates);
      visit("pivots", self.pivots);
      visit("near_contacts", self.near_contacts);
      visit("limit_solves", self.limit_solves);
   }

   /// Adds all counts. Of tangential_unknowns the larger one is kept.
   Counters &operator+=(const Counters &other) { return add(other, 1); }
   /// The difference of two readings: the work done between them.
   Counters &operator-=(const Counters &other) { return add(other, -1); }

private:
   Counters &add(Counters other, long sign)
   {
      const long most = sign > 0 && other.tangential_unknowns > tangential_unknowns
                           ? other.tangential_unknowns
                           : tangential_unknowns;
      long values[32];
      int k = 0;
      for_each(other, [&](const char *, long &value) { values[k++] = value; });
      k = 0;
      for_each(*this, [&](const char *, long &value) { value += sign * values[k++]; });
      tangential_unknowns = most;
      return *this;
   }
};

} // namespace cattaneo
