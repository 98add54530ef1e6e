"""Pictures: functions that draw on axes, return them and never show anything."""

from ratfit.plot.fit import plot_fit as plot_fit
from ratfit.plot.picture import Picture as Picture
from ratfit.plot.study import plot_study as plot_study
