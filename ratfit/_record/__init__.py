"""Measured rows: what one holds, and how rows survive interruption, go on, come together and are compared."""

from ratfit._record.checkpoint import drop_checkpoint as drop_checkpoint
from ratfit._record.checkpoint import no_checkpoint as no_checkpoint
from ratfit._record.checkpoint import read_checkpoint as read_checkpoint
from ratfit._record.checkpoint import write_checkpoint as write_checkpoint
from ratfit._record.compare import Change as Change
from ratfit._record.compare import compare as compare
from ratfit._record.files import write_bytes as write_bytes
from ratfit._record.files import write_text as write_text
from ratfit._record.machine import machine as machine
from ratfit._record.place import unwritable as unwritable
from ratfit._record.resume import check_resumable as check_resumable
from ratfit._record.resume import same_measurement as same_measurement
from ratfit._record.row import FURTHER as FURTHER
from ratfit._record.row import KEYS as KEYS
from ratfit._record.row import PROTOCOL as PROTOCOL
from ratfit._record.row import Record as Record
from ratfit._record.row import Row as Row
from ratfit._record.row import contract as contract
from ratfit._record.rows import append_row as append_row
from ratfit._record.rows import merge as merge
from ratfit._record.rows import read_rows as read_rows
