#include "watch.hpp"

namespace cattaneo::python
{

Watch::Watch(nb::handle progress, nb::handle stop)
   : progress_(nb::borrow(progress)), stop_(nb::borrow(stop))
{
   if (nb::isinstance<nb::bool_>(progress))
   {
      progress_ = nb::cast<bool>(progress)
                     ? nb::module_::import_("cattaneo._progress").attr("Line")()
                     : nb::none();
   }
   else if (PyCallable_Check(progress.ptr()) == 0)
   {
      refuse(progress, "progress", "True, False or a function");
   }
   if (!stop.is_none() && !nb::hasattr(stop, "is_set"))
   {
      refuse(stop, "stop", "None or an object with is_set(), as threading.Event");
   }
}

Monitor Watch::monitor()
{
   ask();
   Monitor monitor;
   monitor.progress = [this](const Progress &progress) { look(progress); };
   monitor.stop = &stopped_;
   return monitor;
}

void Watch::look(const Progress &progress)
{
   const nb::gil_scoped_acquire lock;
   if (PyErr_CheckSignals() != 0) { throw nb::python_error(); }
   if (!progress_.is_none()) { progress_(progress); }
   ask();
}

void Watch::ask()
{
   if (stop_.is_none()) { return; }
   const nb::object answer = stop_.attr("is_set")();
   if (PyObject_IsTrue(answer.ptr()) == 1) { stopped_ = true; }
}

std::recursive_mutex &ipopt()
{
   static std::recursive_mutex solver;
   return solver;
}

void warn(const std::string &sentence)
{
   const nb::object category = nb::module_::import_("cattaneo._core").attr("OutcomeWarning");
   if (PyErr_WarnEx(category.ptr(), sentence.c_str(), 1) != 0) { throw nb::python_error(); }
}

} // namespace cattaneo::python
