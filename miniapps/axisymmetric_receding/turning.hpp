#pragma once

#include "common/run.hpp"

namespace miniapp
{

/// Torque that an axisymmetric contact transmits: Σ r q_θ, opposed to its slip.
double torque(const cattaneo::ReducedProblem &problem, const cattaneo::ContactState &state);

/// The point that a twist has reached.
struct Turned
{
   cattaneo::ContactState state;
   double at = 0; ///< multiplier of the pattern "twist": rotation or torque
   double torque = 0, greatest = 0;
   double stiffness = 0;   ///< torque by multiplier, over the last step
   bool descended = false; ///< the torque has passed a maximum
};

/// Turns a pressed disc by its pattern "twist", in steps that aim at equal parts of a torque.
class Turning
{
public:
   /// @param pressed the loads that are held
   /// @param limit the torque that makes `steps` steps
   Turning(Run &run, const cattaneo::NamedLoads &pressed, double limit, int steps)
      : run_(run), pressed_(pressed), limit_(limit), steps_(steps)
   {
   }

   /// The unit in which stops are counted.
   enum class Stop
   {
      torque,
      multiplier
   };

   /// To be called before the twist: the response of the bonded disc is the first stiffness.
   Turned untwisted(const cattaneo::ContactState &loaded) const;
   /// Goes on until the torque or the multiplier has a value, or the torque has passed its
   /// maximum (which does not stop a search for a multiplier).
   void on(Turned &now, Stop stop, double value, const cattaneo::MarchObserver &observe = {});
   /// The rotation on which the twist does work.
   double rotation(const cattaneo::ContactState &state) const;
   /// The constant loads together with a twist.
   cattaneo::NamedLoads loads(double twist) const;

private:
   void step(Turned &now, double by, const cattaneo::MarchObserver &observe);
   Run &run_;
   cattaneo::NamedLoads pressed_;
   double limit_;
   int steps_;
};

} // namespace miniapp
