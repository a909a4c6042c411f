#pragma once

#include "arguments.hpp"
#include "words.hpp"
#include <cattaneo/readout/edge_fit.hpp>
#include <functional>
#include <memory>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

// Structs of settings as Python classes. Members and their descriptions are those of the C++
// struct: settings.py reads them from its header, and writes for each struct a header with a
// specialisation of bind_settings().

namespace cattaneo::python
{

/// Adds the class of a struct of settings to a module.
template <class T>
void bind_settings(nb::module_ &m);

/// A member in Python: the name of its kind, and how it is read and set. Nested settings are
/// references if `owner` is the object that contains them.
template <class Value>
struct Kind
{
   static std::string name()
   {
      if constexpr (std::is_enum_v<Value>) { return "typing.Literal[" + quoted() + "]"; }
      else if constexpr (nb::detail::is_base_caster_v<nb::detail::make_caster<Value>>)
      {
         const nb::handle type = nb::type<Value>();
         return nb::cast<std::string>(type.attr("__module__")) + "." +
                nb::cast<std::string>(type.attr("__qualname__"));
      }
      else if constexpr (std::is_same_v<Value, std::vector<int>>)
      {
         return "collections.abc.Sequence[int]";
      }
      else { return nb::detail::make_caster<Value>::Name.text; }
   }
   /// The name of the kind in sentences.
   static std::string needed()
   {
      if constexpr (std::is_enum_v<Value>) { return "one of " + quoted(); }
      else { return name(); }
   }
   static nb::object get(Value &value, nb::handle owner)
   {
      if constexpr (std::is_enum_v<Value>) { return nb::cast(word(value)); }
      else if constexpr (std::is_same_v<Value, std::vector<int>>)
      {
         return nb::tuple(
            nb::cast(value)); // a tuple, because changes of a list would have no effect
      }
      else if (owner.is_valid())
      {
         return nb::cast(value, nb::rv_policy::reference_internal, owner);
      }
      else { return nb::cast(value); }
   }
   /// False if `from` is of another kind.
   static bool set(nb::handle from, Value &value, const std::string &what)
   {
      if constexpr (std::is_enum_v<Value>)
      {
         std::string text;
         if (!nb::try_cast(from, text)) { return false; }
         value = chosen<Value>(text, what);
         return true;
      }
      else if constexpr (std::is_same_v<Value, bool>)
      {
         const std::string kind = nb::inst_name(from).c_str(); // NumPy has truth values as well
         value = PyObject_IsTrue(from.ptr()) == 1;
         return kind == "bool" || kind == "numpy.bool" || kind == "numpy.bool_";
      }
      else { return nb::try_cast(from, value); }
   }

private:
   static std::string quoted()
   {
      std::string all;
      for (const std::string &each : words<Value>())
      {
         all += (all.empty() ? "'" : ", '") + each + "'";
      }
      return all;
   }
};
/// Distances from an edge, (nearest, farthest), or None if the fit chooses the window.
template <>
struct Kind<FitWindow>
{
   using Window = std::optional<std::pair<double, double>>;

   static std::string name() { return "tuple[float, float] | None"; }
   static std::string needed() { return "two distances, or None"; }
   static nb::object get(const FitWindow &value, nb::handle)
   {
      const bool chosen = value.nearest == 0 && value.farthest == 0;
      return nb::cast(chosen ? Window() : Window({value.nearest, value.farthest}));
   }
   static bool set(nb::handle from, FitWindow &value, const std::string &)
   {
      Window window;
      if (!nb::try_cast(from, window)) { return false; }
      value = window ? FitWindow{window->first, window->second} : FitWindow{};
      return true;
   }
};

/// A member of settings at a given place in memory.
struct SettingsMember
{
   std::string name, kind, doc;
   std::function<nb::object(void *settings, nb::handle owner)> get;
   /// TypeError or InputError for a value that is not allowed; the member then keeps its value.
   std::function<void(void *settings, nb::handle value)> set;
   /// Sets a member of these settings if this member is itself a struct of settings that has
   /// it.
   std::function<bool(void *settings, const std::string &name, nb::handle value)> set_within;
   std::string value = ""; ///< the default, as a text
};

/// A class of settings, described by its members; compiled once for all structs.
class SettingsClass
{
public:
   SettingsClass(nb::handle type, std::vector<SettingsMember> members, void *defaults);

   /// TypeError for a name that no member has.
   void set(void *settings, const nb::dict &values) const;
   /// A member by its name, also one of nested settings; false if there is none.
   bool set_any(void *settings, const std::string &name, nb::handle value) const;
   /// Members by their names, also those of nested settings; TypeError for a name that no
   /// member has.
   void set_all(void *settings, const nb::kwargs &values) const;
   /// Adds attributes, errors for misspelt ones, printing and pickling; everything but the
   /// constructor.
   void define(const std::shared_ptr<const SettingsClass> &self) const;
   /// Signature of its constructor.
   std::string signature() const;

private:
   std::string unknown(const std::string &name) const;
   const SettingsMember *find(const std::string &name) const;
   /// TypeError unless they are settings of this class.
   void *settings(nb::handle self) const;
   nb::dict values(nb::handle self) const;
   std::string text(nb::handle self) const;

   nb::handle type_;
   std::string name_;
   std::vector<SettingsMember> members_;
};

/// The class of settings T, once it is bound.
template <class T>
std::shared_ptr<const SettingsClass> &settings_class()
{
   static std::shared_ptr<const SettingsClass> bound;
   return bound;
}

/// Sets members that a call gives by name besides its settings.
template <class T>
void set_members(T &settings, const nb::kwargs &members)
{
   settings_class<T>()->set_all(&settings, members);
}

template <class T>
class Settings
{
public:
   Settings(nb::module_ &m, const char *name, const char *doc)
      : class_(m, name, doc), name_(name)
   {
   }

   template <class Value>
   Settings &member(const char *name, Value T::*member, const char *doc)
   {
      const auto get = [member](void *settings, nb::handle owner)
      { return Kind<Value>::get(static_cast<T *>(settings)->*member, owner); };
      const auto set = [member, what = name_ + "." + name](void *settings, nb::handle value)
      {
         // Changes a copy, which is checked before it replaces the settings.
         T changed = *static_cast<T *>(settings);
         if (!Kind<Value>::set(value, changed.*member, what))
         {
            refuse(value, what, Kind<Value>::needed());
         }
         check(changed, 0);
         *static_cast<T *>(settings) = std::move(changed);
      };
      const auto set_within = [member](void *settings, const std::string &of, nb::handle value)
      {
         if constexpr (nb::detail::is_base_caster_v<nb::detail::make_caster<Value>>)
         {
            const auto &within = settings_class<Value>();
            return within && within->set_any(&(static_cast<T *>(settings)->*member), of, value);
         }
         else { return false; }
      };
      members_.push_back({name, Kind<Value>::name(), doc, get, set, set_within});
      return *this;
   }

   /// After all members.
   void done()
   {
      T defaults;
      const auto all = std::make_shared<const SettingsClass>(class_, members_, &defaults);
      all->define(all);
      settings_class<T>() = all;
      const auto made = [all](T *self, const nb::dict &values)
      {
         T settings;
         all->set(&settings, values);
         new (self) T(std::move(settings));
      };
      const std::string signature = all->signature();
      class_
         .def(
            "__init__", [made](T *self, nb::kwargs values) { made(self, values); },
            nb::sig(signature.c_str()))
         .def("__setstate__", made);
   }

private:
   /// The check of the C++ library, if this struct has its own.
   template <class Struct>
   static auto check(const Struct &settings, int) -> decltype(settings.validate())
   {
      settings.validate();
   }
   template <class Struct>
   static void check(const Struct &, long)
   {
   }

   nb::class_<T> class_;
   std::string name_;
   std::vector<SettingsMember> members_;
};

} // namespace cattaneo::python
