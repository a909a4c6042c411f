#pragma once

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/reduced/interfaces.hpp>

namespace cattaneo
{

/// A body of a union, with its name in messages.
struct NamedBody
{
   std::string name;        ///< unique among the bodies
   const ElasticBody *body; ///< not owned
};

/// A side of an interface: a part of the boundary of a body, or a rigid obstacle.
struct BoundarySide
{
   int body = -1;                       ///< number of the body; -1: a rigid obstacle
   BoundaryPart part = BoundaryPart(1); ///< part of its boundary; not used for a rigid obstacle
};

/// An Interface (see there) between MFEM bodies.
struct BoundaryInterface
{
   std::string name;                              ///< unique among the interfaces
   BoundarySide first;                            ///< body 1 of its frames
   BoundarySide second;                           ///< the other body, or a rigid obstacle
   SlaveSide slave = SlaveSide::coarser;          ///< which of the two has the nodes
   std::optional<ScalarField> gap = std::nullopt; ///< the geometry's unless given
   /// In lengths of an element; a larger overlap is an error
   double most_overlap = Interface().most_overlap;
   bool tied = false; ///< joined permanently
   /// True: gaps are those of the meshes' edges. False: straight edges whose vertices lie as on
   /// a smooth curve are taken for its chords (smooth_curve()), and gaps are measured between
   /// the curves, without changing the meshes. With elements of order 2 or more it is better to
   /// call curve_sides() before the bodies are made, which moves their nodes onto the curves.
   bool as_meshed = false;
};

/** Any number of MFEM bodies over any number of interfaces, whose meshes need not match: each
    body is condensed once to the contact lines of all of its sides, equal ones (the same
    operator and contact dofs) with one factor. InputError as of contact_line(), condense() and
    reduce(). Collective. */
Reduction reduce(const std::vector<NamedBody> &bodies,
                 const std::vector<BoundaryInterface> &interfaces,
                 const CondenseSettings &settings = {});

} // namespace cattaneo
