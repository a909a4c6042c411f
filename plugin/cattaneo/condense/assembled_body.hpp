#pragma once

#include <cattaneo/condense/rigid_motion.hpp>
#include <cattaneo/load_pattern.hpp>
#include <string>
#include <vector>

namespace cattaneo
{

/// A load pattern on all dofs of a body.
struct BodyLoad
{
   std::string name;                 ///< one that no other load of the body has
   Control control = Control::force; ///< what the multiplier scales
   Eigen::VectorXd values;           ///< force control: forces; displacement: prescribed values
};

/// A common motion of fixed dofs: a part of the body moves freely as a rigid block.
struct BlockMotion
{
   Eigen::VectorXd motion; ///< of all dofs, zero where they are not fixed
   std::string load;       ///< name of the load that is the force on the block, empty: none
   double force =
      0; ///< force on the block per unit multiplier of that load, conjugate to the motion
};

/// A body as any program assembles it: what a condensation by a factor starts from.
struct AssembledBody
{
   /// Symmetric, of all dofs, supported ones among them; each entry once.
   SharedMatrix K;
   std::vector<int>
      fixed;         ///< sorted: fixed, prescribed by a load of displacements, or a block's
   DofPlaces places; ///< of all dofs
   std::vector<BodyLoad> loads; ///< with different names
   /// True if K may resist rigid motions (elastic foundations, springs that do not connect x
   /// with y): motions that K resists then count as supported. False: all rigid motions that
   /// the supports leave count as free. A body is then refused if contact nodes and supports
   /// together leave a motion free, or if eliminated() rows resist one.
   bool grounded = false;
   /// Blocks that move rigidly, linearly independent. A rigid motion is free if it is a
   /// combination of them.
   std::vector<BlockMotion> blocks = {};

   /** Rows of supports that the program which wrote K has eliminated: rows that are not fixed
       and have only their diagonal, or no entry at all, while other rows of the same component
       have more. Entries off the diagonal count as zero if they are below 1e-12 of the largest
       such entry, unless the diagonal is as small, or if they are round-off of a large
       diagonal. An eliminated row is a support for all others, to round-off, whether it was
       eliminated or is a much stiffer spring. condense() takes these rows as fixed if the body
       is `grounded`. Otherwise it refuses them, because as springs they would not move the
       body. If no row of a component is connected to another row, the component is a bed of
       springs and is kept. */
   std::vector<int> eliminated() const;
   /// A warning about eliminated() rows that condense() takes as fixed. Empty if there are
   /// none.
   std::string eliminated_warning() const;

   /// InputError that names the fault: blocks whose dofs are not fixed, sizes, columns, a
   /// repeated entry, or the order of the fixed dofs. Loads must be finite and have different
   /// names. They may displace only fixed dofs that are coupled to others (not those of an
   /// eliminated matrix). The stiffness must be symmetric, not one triangle. A body that is not
   /// grounded may have no eliminated() rows. No node may be held obliquely to the axes by a
   /// diagonal alone (an eliminated support on a slope). This is not checked in space.
   void validate() const;
   /// The message about a load that displaces dofs without coupling to others.
   static constexpr const char *feels_nothing =
      "moves nothing, because the rows of the displaced dofs have only a diagonal: was the "
      "matrix eliminated? Pass it as assembled (SpMat() after Finalize)";
};

/// The message about that many eliminated rows, with the component and the place, as text, of
/// the first of them.
std::string eliminated_rows(std::size_t count, Formulation formulation, int component,
                            const std::string &place);

} // namespace cattaneo
