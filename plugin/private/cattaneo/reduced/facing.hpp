#pragma once

#include <cattaneo/condense/contact_line.hpp>

namespace cattaneo
{

/// Element of a contact line as a curve 0 <= s <= 1, with the line's own tangents interpolated
/// between its nodes, so that they turn without a jump from one element to the next.
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
   /// An estimate of how far a smooth curve lies from the element at s, where no curve is known
   /// that it is a chord of: one through the same nodes, with the tangents of the line at both
   /// ends. 0 at corners.
   Eigen::Vector2d bulge(double s) const;
};

/// The box around a line, in a sentence.
std::string extent(const ContactLine &line);

/// All elements of a line. InputError if it has none, or of an order beyond 1 to 8.
std::vector<ElementCurve> curves(const ContactLine &line, const std::string &what);

/// The part from < s < to of an element of the first line that faces an element of the other.
struct FacingPart
{
   std::size_t element = 0, other = 0;
   double from = 0, to = 1;
};

/** Two points face each other if the line between them is across the mean of both tangents,
    (x₁ - x₂)·(t₁ - t₂) = 0, whichever line is called the first, and the tangents are
    opposed. */
struct FacingLines
{
   std::vector<ElementCurve> first, other;
   /// In the order of the first line's elements and along them; each point of the first line
   /// faces at most one element, the nearest.
   std::vector<FacingPart> parts;

   /// The parameter on the other line's element of what faces s.
   double opposite(const FacingPart &part, double s) const;
};

/// @a what begins the sentences about lines that do not fit.
FacingLines facing(const ContactLine &first, const ContactLine &other, const std::string &what);

} // namespace cattaneo
