#pragma once

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/reduced/interfaces.hpp>

namespace cattaneo
{

/// A body of a union, with its name in sentences about it.
struct NamedBody
{
   std::string name;
   const ElasticBody *body;
};

/// A side of an interface: a part of the boundary of a body, or a rigid obstacle.
struct BoundarySide
{
   int body = -1; ///< number of the body; -1: a rigid obstacle
   BoundaryPart part = BoundaryPart(1);
};

/// Interface of MFEM bodies, see there.
struct BoundaryInterface
{
   std::string name;
   BoundarySide first, second;
   SlaveSide slave = SlaveSide::coarser;
   std::optional<ScalarField> gap = std::nullopt;
   double most_overlap = Interface().most_overlap;
   bool tied = false;
};

/** Any number of MFEM bodies over any number of interfaces, whose meshes need not match: each
    body is condensed once to the contact lines of all of its sides, equal ones (the same
    operator and contact dofs) with one factor. InputError as of contact_line(), condense() and
    reduce(). Collective. */
Reduction reduce(const std::vector<NamedBody> &bodies,
                 const std::vector<BoundaryInterface> &interfaces,
                 const CondenseSettings &settings = {});

} // namespace cattaneo
