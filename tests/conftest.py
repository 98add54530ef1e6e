"""What several tests share."""

import pytest

from ratfit.cli import main


@pytest.fixture
def run(capsys):
    """The command line in this process: words -> exit status, standard output and standard error."""

    def run(*words):
        with pytest.raises(SystemExit) as stop:
            main(list(words))
        out, err = capsys.readouterr()
        return stop.value.code, out, err

    return run
