//! A picture of measurements: adjacent panels, both axes logarithmic, as SVG.

use std::fmt::Write;

/// One panel.
pub struct Panel {
    pub title: &'static str,
    pub lines: Vec<Line>,
    pub limit: Limit,
}

/// Measurements of one kind; points that are not positive numbers are left out.
pub struct Line {
    pub name: &'static str,
    /// Its colour in SVG.
    pub colour: &'static str,
    pub points: Vec<[f64; 2]>,
}

/// A limit: a point below which the lines should stay.
pub struct Limit {
    pub at: [f64; 2],
    pub name: String,
}

/// A panel's width and height in pixels, and the margin around it.
const SIZE: [f64; 2] = [400.0, 260.0];
const LEFT: f64 = 64.0;
const TOP: f64 = 44.0;
const BELOW: f64 = 74.0;

/// The panels in a row; `across` is the common quantity along x, and `caption` is below.
pub fn chart(panels: &[Panel], across: &str, caption: &str) -> String {
    let pitch = LEFT + SIZE[0] + 24.0;
    let (width, height) = (pitch * panels.len() as f64, TOP + SIZE[1] + BELOW);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
         font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    for (number, panel) in panels.iter().enumerate() {
        let x = LEFT + number as f64 * pitch;
        let _ = writeln!(svg, "<g transform=\"translate({x} {TOP})\">");
        draw(&mut svg, panel, across);
        svg.push_str("</g>\n");
    }
    let _ = writeln!(svg, "{}", text([LEFT, height - 10.0], "start", "#555", caption));
    svg.push_str("</svg>\n");
    svg
}

fn draw(svg: &mut String, panel: &Panel, across: &str) {
    let points = || {
        panel
            .lines
            .iter()
            .flat_map(|line| &line.points)
            .chain([&panel.limit.at])
    };
    let range = |axis: usize| Range::of(points().map(|point| point[axis]).filter(|value| *value > 0.0));
    let (Some(horizontal), Some(vertical)) = (range(0), range(1)) else {
        return;
    };
    let place = |[x, y]: [f64; 2]| [SIZE[0] * horizontal.share(x), SIZE[1] * (1.0 - vertical.share(y))];
    let _ = writeln!(svg, "{}", text([0.0, -26.0], "start", "#000", panel.title));
    for x in horizontal.ticks() {
        let [at, _] = place([x, 1.0]);
        let _ = writeln!(svg, "<path d=\"M{at:.1} 0V{}\" stroke=\"#ddd\"/>", SIZE[1]);
        let _ = writeln!(svg, "{}", text([at, SIZE[1] + 18.0], "middle", "#000", &short(x)));
    }
    for y in vertical.ticks() {
        let [_, at] = place([1.0, y]);
        let _ = writeln!(svg, "<path d=\"M0 {at:.1}H{}\" stroke=\"#ddd\"/>", SIZE[0]);
        let _ = writeln!(svg, "{}", text([-8.0, at + 4.0], "end", "#000", &short(y)));
    }
    let _ = writeln!(
        svg,
        "{}",
        text([0.5 * SIZE[0], SIZE[1] + 36.0], "middle", "#000", across)
    );
    let [x, y] = place(panel.limit.at);
    let _ = writeln!(
        svg,
        "<path d=\"M{:.1} {y:.1}h32\" stroke=\"#000\" stroke-width=\"2\"/>",
        x - 16.0
    );
    let _ = writeln!(svg, "{}", text([x - 20.0, y + 4.0], "end", "#000", &panel.limit.name));
    for (number, line) in panel.lines.iter().enumerate() {
        let seen = line
            .points
            .iter()
            .filter(|point| point.iter().all(|value| *value > 0.0));
        let places: Vec<String> = seen
            .map(|point| place(*point))
            .map(|[x, y]| format!("{x:.1},{y:.1}"))
            .collect();
        let (colour, path) = (line.colour, places.join(" "));
        let _ = writeln!(
            svg,
            "<polyline points=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>"
        );
        for place in &places {
            let (x, y) = place.split_once(',').unwrap_or_default();
            let _ = writeln!(svg, "<circle cx=\"{x}\" cy=\"{y}\" r=\"3.5\" fill=\"{colour}\"/>");
        }
        let name = text([number as f64 * 120.0, -9.0], "start", colour, line.name);
        let _ = writeln!(svg, "{name}");
    }
}

fn text([x, y]: [f64; 2], anchor: &str, colour: &str, words: &str) -> String {
    format!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{colour}\">{words}</text>")
}

/// A logarithmic axis.
struct Range {
    low: f64,
    high: f64,
}

impl Range {
    /// An axis with some margin around positive values; `None` if there are none.
    fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        (low <= high).then_some(Self {
            low: low / 1.4,
            high: high * 1.4,
        })
    }

    /// The place of a value, 0 to 1.
    fn share(&self, value: f64) -> f64 {
        (value / self.low).ln() / (self.high / self.low).ln()
    }

    /// 1, 2 and 5 times powers of ten.
    fn ticks(&self) -> Vec<f64> {
        let decades = self.low.log10().floor() as i32..=self.high.log10().ceil() as i32;
        let ticks = decades.flat_map(|decade| [1.0, 2.0, 5.0].map(|digit| digit * 10_f64.powi(decade)));
        ticks.filter(|tick| (self.low..=self.high).contains(tick)).collect()
    }
}

/// A count as "50k" or "2M".
fn short(value: f64) -> String {
    match value {
        1e6.. => format!("{}M", value / 1e6),
        1e4.. => format!("{}k", value / 1e3),
        _ => format!("{value}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_is_within_its_panel_and_numbers_that_are_none_are_left_out() {
        let panel = Panel {
            title: "growth",
            lines: vec![Line {
                name: "a way",
                colour: "red",
                points: vec![[5e4, 3.0], [5e6, 30.0], [1e6, f64::NAN]],
            }],
            limit: Limit {
                at: [5e6, 12.0],
                name: "the limit".to_owned(),
            },
        };
        let svg = chart(&[panel], "vertices", "a machine");
        let places: Vec<f64> = svg
            .lines()
            .filter_map(|line| line.strip_prefix("<circle cx=\""))
            .filter_map(|rest| rest.split('"').next()?.parse().ok())
            .collect();
        assert_eq!(places.len(), 2);
        assert!(places.iter().all(|x| (0.0..SIZE[0]).contains(x)) && places[0] < places[1]);
        assert!(!svg.contains("NaN") && svg.contains("a machine") && svg.contains(">the limit<"));
    }

    #[test]
    fn ticks_are_round_and_within_the_range() {
        let range = Range { low: 3.0, high: 120.0 };
        assert_eq!(range.ticks(), [5.0, 10.0, 20.0, 50.0, 100.0]);
        assert_eq!([range.share(3.0), range.share(120.0)], [0.0, 1.0]);
        assert_eq!([5e4, 2e6, 12.0].map(short), ["50k", "2M", "12"]);
    }
}
