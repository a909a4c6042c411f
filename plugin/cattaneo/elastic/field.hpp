#pragma once

#include <cattaneo/material.hpp>
#include <functional>
#include <mfem.hpp>
#include <string>
#include <type_traits>
#include <utility>

namespace cattaneo
{

/// A value that may vary over a body: a number, a function of (x, y), in space of (x, y, z), or
/// an mfem::Coefficient, which must live as long as it may be used.
class Field
{
public:
   /// The same everywhere.
   Field(double constant) : f_([constant](mfem::ElementTransformation &) { return constant; })
   {
   }
   /// A coefficient of MFEM, which must live as long as the field.
   Field(mfem::Coefficient &coefficient)
      : f_([&coefficient](mfem::ElementTransformation &at)
           { return coefficient.Eval(at, at.GetIntPoint()); })
   {
   }
   /// A function of (x, y), or of (x, y, z).
   template <class F,
             class = std::enable_if_t<std::is_invocable_r_v<double, F, double, double> ||
                                      std::is_invocable_r_v<double, F, double, double, double>>>
   Field(F f)
      : f_(
           [f = std::move(f)](mfem::ElementTransformation &at)
           {
              mfem::Vector x(at.GetSpaceDim());
              at.Transform(at.GetIntPoint(), x);
              if constexpr (std::is_invocable_r_v<double, F, double, double, double>)
              {
                 return f(x(0), x(1), x.Size() > 2 ? x(2) : 0.0);
              }
              else { return f(x(0), x(1)); }
           })
   {
   }
   /// Value at the point that is set in the transformation of an element or a boundary element.
   /// InputError, starting with `where`, if it is not finite.
   double at(mfem::ElementTransformation &place, const std::string &where) const;

private:
   std::function<double(mfem::ElementTransformation &)> f_;
};

/// Isotropic elasticity whose constants vary over a body.
struct VaryingMaterial
{
   Field young;                           ///< Young's modulus, in the range that Material has
   Field poisson;                         ///< Poisson's ratio, likewise
   PlaneState state = PlaneState::strain; ///< strain or stress, everywhere the same

   /// Material at the point that is set in the transformation. InputError that names the point
   /// if the material is not valid there.
   Material at(mfem::ElementTransformation &place) const;
};

} // namespace cattaneo
