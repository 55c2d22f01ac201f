"""How the figures look: one size of text, few lines, colours that the colour-blind tell apart."""

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402 (the backend comes first)
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator  # noqa: E402
from matplotlib.patheffects import withStroke  # noqa: E402

from .paths import RESULTS  # noqa: E402

FIGURES = RESULTS / 'figures'
WIDTH = 8.6  # of a figure over the whole page [inch]

# Okabe and Ito's palette.
BLACK, ORANGE, SKY, GREEN = '#000000', '#e69f00', '#56b4e9', '#009e73'
YELLOW, BLUE, VERMILION, PURPLE = '#f0e442', '#0072b2', '#d55e00', '#cc79a7'
GREY = '0.55'

plt.rcParams.update({
    'font.size': 9.0,
    'axes.titlesize': 9.5,
    'axes.spines.top': False,
    'axes.spines.right': False,
    'axes.linewidth': 0.7,
    'axes.grid': True,
    'axes.axisbelow': True,
    'grid.color': '0.91',
    'grid.linewidth': 0.6,
    'lines.linewidth': 1.4,
    'lines.markersize': 4.5,
    'xtick.major.width': 0.7,
    'ytick.major.width': 0.7,
    'legend.frameon': False,
    'legend.fontsize': 8.5,
    'svg.fonttype': 'path',
    'figure.dpi': 100,
})


def vacuum_color(pressure):
    """Of a gauge pressure [Pa], the same in all figures: from light at -2 kPa to dark at -12."""
    return plt.get_cmap('viridis')(0.75 * min(1.0, max(0.0, (12e3 + pressure) / 10e3)))


def label(axis, x, y, text, color, dx=4, dy=0, **options):
    """Text beside a point, instead of a legend."""
    axis.annotate(text, (x, y), xytext=(dx, dy), textcoords='offset points', color=color,
                  va='center', fontsize=8.5,
                  path_effects=[withStroke(linewidth=2.5, foreground='white')], **options)


def log_ticks(axis, ticks):
    """A logarithmic axis (axes.xaxis or axes.yaxis) with plain numbers at the ticks."""
    set_scale = axis.axes.set_xscale if axis.axis_name == 'x' else axis.axes.set_yscale
    set_scale('log')
    axis.set_major_locator(FixedLocator(list(ticks)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f'{value:g}'))
    axis.set_minor_locator(NullLocator())


def legend_below(figure, handles, labels, columns):
    """Below all axes; save() makes the page tall enough."""
    figure.legend(handles, labels, loc='upper center', bbox_to_anchor=(0.5, 0.0), ncol=columns)


def save(figure, name):
    """Writes results/validation/figures/NAME.svg."""
    FIGURES.mkdir(parents=True, exist_ok=True)
    # The salt makes the ids in the file those of this figure: several stand in one page.
    with matplotlib.rc_context({'svg.hashsalt': name}):
        figure.savefig(FIGURES / f'{name}.svg', metadata={'Date': None}, bbox_inches='tight',
                       pad_inches=0.05)
    plt.close(figure)
