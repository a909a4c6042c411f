#pragma once

#include <cattaneo/condense/contact_line.hpp>

namespace cattaneo
{

/// Element of a contact line as a curve 0 <= s <= 1. Its tangents are those of the line at the
/// nodes, interpolated between them, so that they do not jump from one element to the next.
struct ElementCurve
{
   const LineElement *element = nullptr;
   Eigen::Matrix2Xd tangents; ///< of the nodes

   Eigen::Index order() const { return element->order(); }
   Eigen::VectorXd functions(double s) const;
   Eigen::Vector2d place(double s) const;
   Eigen::Vector2d derivative(double s) const;
   Eigen::Vector2d tangent(double s) const; ///< not of length 1
   double length() const;
   /// Estimated distance of a smooth curve from the element at s, if the curve itself is not
   /// known: it goes through the same nodes, with the tangents of the line at both ends. 0 at
   /// corners.
   Eigen::Vector2d bulge(double s) const;
};

/// The box around a line, in a sentence.
std::string extent(const ContactLine &line);

/// All elements of a line. InputError if it has no elements, or one whose order is not from 1
/// to 8.
std::vector<ElementCurve> curves(const ContactLine &line, const std::string &what);

/// The part from < s < to of an element of the first line that faces an element of the other.
struct FacingPart
{
   std::size_t element = 0, other = 0;
   double from = 0, to = 1;
};

/** Two points face each other if their tangents are opposed and the line between the points is
    across the mean of both tangents, (x₁ - x₂)·(t₁ - t₂) = 0. It does not matter which line is
    called the first. */
struct FacingLines
{
   std::vector<ElementCurve> first, other;
   /// In the order of the first line's elements and along them; each point of the first line
   /// faces at most one element, the nearest.
   std::vector<FacingPart> parts;

   /// Parameter, on the other line's element, of the point that faces s.
   double opposite(const FacingPart &part, double s) const;
};

/// @a what: the beginning of messages about lines that do not fit.
FacingLines facing(const ContactLine &first, const ContactLine &other, const std::string &what);

} // namespace cattaneo
