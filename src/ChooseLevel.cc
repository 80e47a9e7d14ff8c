/// @file ChooseLevel.cc
/// By the options, else by the grid's class, else by its background.
#include "ChooseLevel.h"

#include <vdbtet/Errors.h>

#include <cmath>
#include <sstream>

namespace vdbtet {

std::string quoted(const openvdb::GridBase& grid) {
    return grid.getName().empty() ? std::string("the unnamed grid") : "grid '" + grid.getName() + "'";
}

Level chooseLevel(const openvdb::GridBase& grid, double background, const Options& options, Report& report) {
    const openvdb::GridClass gridClass = grid.getGridClass();
    const bool levelSet = gridClass == openvdb::GRID_LEVEL_SET, fog = gridClass == openvdb::GRID_FOG_VOLUME;
    const bool replaced = !std::isfinite(background) && options.nan != Nan::Error;
    if (replaced && options.nan == Nan::Inside)
        throw UnboundedInside("the background is NaN or infinite, and such values are to be inside, so the "
                              "inside has no end; mesh them as outside");
    if (replaced && !levelSet && !fog && (!options.isovalue || options.inside == Inside::Automatic)) {
        throw BadValue("the background is NaN or infinite, and no class of the grid tells what is inside; "
                       "give the isovalue and the side of it, or set the class");
    }
    Level level;
    level.isovalue = options.isovalue.value_or(levelSet || (!fog && background > 0.0) ? 0.0 : 0.5);

    std::ostringstream why;
    if (options.inside != Inside::Automatic) {
        level.insideIsBelow = options.inside == Inside::Below;
        why << "as asked";
    } else if (levelSet || fog) {
        level.insideIsBelow = levelSet;
        why << (levelSet ? "level set" : "fog volume");
    } else {
        level.insideIsBelow = background > level.isovalue;
        why << "class '" << openvdb::GridBase::gridClassToString(gridClass) << "', and the background "
            << background << " is " << (level.insideIsBelow ? "above" : "not above");
    }
    std::ostringstream rule;
    rule << "inside is " << (level.insideIsBelow ? "< " : "> ") << level.isovalue << " (" << why.str() << ")";
    report.isovalue = level.isovalue;
    report.inside = level.insideIsBelow ? Inside::Below : Inside::Above;
    report.insideRule = rule.str();
    if (!replaced && level.phi(background) >= 0.0) {
        std::ostringstream message;
        message << "the background value " << background
                << " lies inside, so the inside has no end: " << report.insideRule
                << "; choose another isovalue, or mesh the other side";
        throw UnboundedInside(message.str());
    }
    return level;
}

void requireInside(const ValueRange& values, const Level& level) {
    if (level.phi(values.min) >= 0.0 || level.phi(values.max) >= 0.0) return;
    std::ostringstream message;
    message << "no value is " << (level.insideIsBelow ? "below" : "above") << " the isovalue "
            << level.isovalue << ", the values being from " << values.min << " to " << values.max
            << "; choose another isovalue";
    throw NoSurface(message.str());
}

} // namespace vdbtet
