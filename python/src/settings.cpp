#include "settings.hpp"

#include <algorithm>

namespace cattaneo::python
{

namespace
{

std::string written(nb::handle value)
{
   return nb::repr(value).c_str();
}

} // namespace

void SettingsClass::add(std::string member, std::string kind, nb::handle value, Setter setter)
{
   members_.push_back({std::move(member), std::move(kind), written(value), std::move(setter)});
}

std::string SettingsClass::unknown(const std::string &name) const
{
   std::string all;
   for (const Member &each : members_) { all += (all.empty() ? "'" : ", '") + each.name + "'"; }
   return name_ + " has no '" + name + "', it has " + all;
}

void SettingsClass::set(void *settings, nb::kwargs values) const
{
   for (const auto &[key, value] : values)
   {
      const auto name = nb::cast<std::string>(key);
      const auto found = std::find_if(members_.begin(), members_.end(),
                                      [&](const Member &each) { return each.name == name; });
      if (found == members_.end()) { throw nb::type_error(unknown(name).c_str()); }
      found->set(settings, value);
   }
}

void SettingsClass::require_member(const std::string &name) const
{
   if (std::none_of(members_.begin(), members_.end(),
                    [&](const Member &each) { return each.name == name; }))
   {
      throw nb::attribute_error(unknown(name).c_str());
   }
}

nb::dict SettingsClass::values(nb::handle settings) const
{
   nb::dict all;
   for (const Member &each : members_)
   {
      all[each.name.c_str()] = settings.attr(each.name.c_str());
   }
   return all;
}

std::string SettingsClass::text(nb::handle settings) const
{
   std::string all;
   for (const Member &each : members_)
   {
      const std::string value = written(nb::object(settings.attr(each.name.c_str())));
      if (value == each.value) { continue; }
      all += (all.empty() ? "" : ", ") + each.name + "=" + value;
   }
   return name_ + "(" + all + ")";
}

std::string SettingsClass::signature() const
{
   std::string all = "def __init__(self, *";
   for (const Member &each : members_)
   {
      // A stub knows numbers, words and tuples.
      const bool known =
         each.value != "inf" && (each.value[0] == '(' || each.value.back() != ')');
      all += ", " + each.name + ": " + each.kind + " = " + (known ? each.value : "...");
   }
   return all + ") -> None";
}

} // namespace cattaneo::python
