// The page's charts, drawn with Observable Plot: the one part of the report that is bundled, since the library is made
// of modules. A page without the bundle shows the program's own charts instead.

import {icon} from "./marks.js";
import {over_time} from "./over_time.js";
import {pareto} from "./pareto.js";
import {strips} from "./strips.js";

window.ZonalCharts = {icon, over_time, pareto, strips};
